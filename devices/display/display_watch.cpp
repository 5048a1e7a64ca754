#include "devices/display/display_watch.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <xcb/randr.h>
#include <xcb/screensaver.h>
#include <xcb/xcb.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <utility>

#include "devices/display/display_error.h"

namespace pixelflex::devices {

struct DisplayWatch::State {
  explicit State(std::function<void()> onMonitorsChanged)
      : onChange(std::move(onMonitorsChanged)), x(xcb_connect(nullptr, &screen)) {
    if (xcb_connection_has_error(x) != 0) {
      xcb_disconnect(x);
      throw DisplayError("cannot watch the display's monitors: the X server does not answer");
    }
    holdOffSaver();
    followMonitors();
    stop = eventfd(0, EFD_CLOEXEC);
    thread = std::thread([this] { run(); });
  }
  ~State() {
    eventfd_write(stop, 1);
    thread.join();
    close(stop);
    xcb_disconnect(x);  // which lets the saver go again
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[nodiscard]] bool has(xcb_extension_t& extension) const {
    const auto* const data = xcb_get_extension_data(x, &extension);
    return data != nullptr && data->present != 0;
  }
  // X servers without one of the extensions have no saver, or monitors that stay.
  void holdOffSaver() const {
    if (!has(xcb_screensaver_id)) return;
    std::free(xcb_screensaver_query_version_reply(x, xcb_screensaver_query_version(x, 1, 1), nullptr));
    xcb_screensaver_suspend(x, 1);
  }
  void followMonitors() {
    if (!has(xcb_randr_id)) return;
    firstMonitorEvent = xcb_get_extension_data(x, &xcb_randr_id)->first_event;
    std::free(xcb_randr_query_version_reply(x, xcb_randr_query_version(x, 1, 5), nullptr));
    auto roots = xcb_setup_roots_iterator(xcb_get_setup(x));
    for (int i = 0; i < screen && roots.rem > 1; ++i) xcb_screen_next(&roots);
    const xcb_window_t root = roots.data->root;
    xcb_randr_select_input(
        x, root,
        XCB_RANDR_NOTIFY_MASK_SCREEN_CHANGE | XCB_RANDR_NOTIFY_MASK_CRTC_CHANGE | XCB_RANDR_NOTIFY_MASK_OUTPUT_CHANGE);
  }
  [[nodiscard]] bool isAboutMonitors(const xcb_generic_event_t& event) const {
    const int number = (event.response_type & 0x7f) - firstMonitorEvent;
    return number == XCB_RANDR_SCREEN_CHANGE_NOTIFY || number == XCB_RANDR_NOTIFY;
  }
  void run() const {
    while (xcb_connection_has_error(x) == 0) {
      bool changed = false;
      while (auto* const event = xcb_poll_for_event(x)) {
        changed = changed || isAboutMonitors(*event);
        std::free(event);
      }
      if (changed) onChange();
      xcb_flush(x);
      std::array<pollfd, 2> watched{{{xcb_get_file_descriptor(x), POLLIN, 0}, {stop, POLLIN, 0}}};
      poll(watched.data(), watched.size(), -1);
      if (watched[1].revents != 0) return;
    }
  }

  std::function<void()> onChange;
  int screen = 0;  // of the display, as its name says
  xcb_connection_t* x;
  int firstMonitorEvent = 1000;  // beyond every event
  int stop = -1;
  std::thread thread;
};

DisplayWatch::DisplayWatch(std::function<void()> onMonitorsChanged)
    : state_(std::make_unique<State>(std::move(onMonitorsChanged))) {}

DisplayWatch::~DisplayWatch() = default;

void DisplayWatch::ringBell() {
  xcb_bell(state_->x, 0);
  xcb_flush(state_->x);
}

}  // namespace pixelflex::devices
