#include "devices/display/clipboard.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <xcb/xcb.h>
#include <xcb/xfixes.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "devices/display/selection.h"

namespace pixelflex::devices {
namespace {

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

template <class Event>
const Event& as(const xcb_generic_event_t& event) {
  return reinterpret_cast<const Event&>(event);
}

}  // namespace

class Clipboard::Worker {
 public:
  Worker(Selection selection, std::size_t limit, ClipboardHandlers handlers)
      : handlers_(std::move(handlers)),
        desk_(selection == Selection::kPrimary ? "PRIMARY" : "CLIPBOARD"),
        incoming_(desk_, limit),
        outgoing_(desk_),
        woken_(eventfd(0, EFD_CLOEXEC)) {
    incoming_.ask();
    thread_ = std::thread([this] { run(); });
  }
  ~Worker() {
    stopped_ = true;
    wake();
    thread_.join();
    close(woken_);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void set(std::string text) {
    {
      const std::scoped_lock lock(mutex_);
      toOffer_ = std::move(text);
    }
    wake();
  }

 private:
  void wake() const { eventfd_write(woken_, 1); }

  void run() {
    while (!stopped_) {
      while (const auto event = std::unique_ptr<xcb_generic_event_t, Free>(xcb_poll_for_event(desk_.x())))
        handle(*event);
      if (xcb_connection_has_error(desk_.x()) != 0) return;
      offer();
      xcb_flush(desk_.x());
      std::array<pollfd, 2> watched{{{xcb_get_file_descriptor(desk_.x()), POLLIN, 0}, {woken_, POLLIN, 0}}};
      poll(watched.data(), watched.size(), -1);
      eventfd_t count = 0;
      if (watched[1].revents != 0) eventfd_read(woken_, &count);
    }
  }

  void offer() {
    const std::scoped_lock lock(mutex_);
    if (toOffer_) outgoing_.offer(*std::exchange(toOffer_, std::nullopt));
  }

  void handle(const xcb_generic_event_t& event) {
    const int type = event.response_type & 0x7f;
    if (type == desk_.ownerChanged) {
      const auto owner = as<xcb_xfixes_selection_notify_event_t>(event).owner;
      if (owner != desk_.window && owner != XCB_NONE) incoming_.ask();
    } else if (type == XCB_SELECTION_NOTIFY) {
      hand(incoming_.answered(as<xcb_selection_notify_event_t>(event).property));
    } else if (type == XCB_SELECTION_REQUEST) {
      outgoing_.serve(as<xcb_selection_request_event_t>(event));
    } else if (type == XCB_PROPERTY_NOTIFY) {
      const auto& changed = as<xcb_property_notify_event_t>(event);
      const bool ours = changed.window == desk_.window && changed.atom == desk_.property;
      if (ours && changed.state == XCB_PROPERTY_NEW_VALUE) hand(incoming_.continued());
      if (changed.state == XCB_PROPERTY_DELETE) outgoing_.continueFor(changed.window, changed.atom);
    }
  }

  void hand(std::optional<std::string> text) {
    if (incoming_.takeTooLong()) handlers_.tooLong();
    if (text && !text->empty()) handlers_.copied(*std::move(text));
  }

  ClipboardHandlers handlers_;
  SelectionDesk desk_;
  IncomingSelection incoming_;
  OutgoingSelection outgoing_;
  int woken_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::optional<std::string> toOffer_;
  std::thread thread_;
};

Clipboard::Clipboard(Selection selection, std::size_t limit, ClipboardHandlers handlers)
    : worker_(std::make_unique<Worker>(selection, limit, std::move(handlers))) {}

Clipboard::~Clipboard() = default;

void Clipboard::set(std::string text) {
  worker_->set(std::move(text));
}

}  // namespace pixelflex::devices
