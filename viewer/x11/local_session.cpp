#include "viewer/x11/local_session.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <semaphore>
#include <thread>
#include <utility>

#include "viewer/vnc/reconnection.h"
#include "viewer/vnc/session_desk.h"
#include "viewer/vnc/session_error.h"
#include "viewer/x11/local_desktop.h"

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// How long a session that ends may take to let go of keys and buttons.
constexpr std::chrono::milliseconds kGoodbye{500};
// Programs may move the pointer without a word.
constexpr std::chrono::milliseconds kLookPeriod{100};

bool takesMore(int socket) {
  pollfd watched{socket, POLLOUT, 0};
  return ::poll(&watched, 1, 0) > 0;
}

}  // namespace

class LocalSession::Worker {
 public:
  Worker(LocalSessionOptions options, FrameBelt& belt, std::function<void()> wake)
      : options_(options),
        belt_(belt),
        desk_(!options.viewOnly, std::move(wake)),
        connection_(options.retry, "the session with the X server " + options.display.text(), desk_) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      connection_.run(stop, [&] { talk(stop); });
      finished_.release();
    });
  }
  ~Worker() {
    stop();
    if (!finished_.try_acquire_for(kGoodbye)) cut();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  SessionDesk& desk() { return desk_; }

  void stop() {
    thread_.request_stop();
    desk_.stop();
  }

 private:
  [[noreturn]] void talk(const std::stop_token& stop) {
    const XConnection connection(options_.display, desk_.stopped(), options_.patience);
    hold(connection.fd());
    LocalDesktop desktop(
        connection,
        {.pointerAndKeys = !options_.viewOnly, .clipboardLimit = options_.clipboardLimit, .primary = options_.primary});
    announce(desktop);
    while (true) {
      bool busy = desktop.listen();
      if (takesMore(connection.fd())) {
        for (const Input& input : desk_.takeInput()) {
          desktop.take(input);
          busy = true;
        }
      }
      desk_.post(desktop.takeEvents());
      if (desktop.damaged() && Clock::now() >= desktop.publishDue()) {
        desktop.publish(belt_, stop, updates_);
        busy = true;
      }
      // Whatever was asked may have brought events along, for which the socket will not wake us.
      if (!busy) rest(connection, desktop);
      if (stop.stop_requested()) throw SessionStopped{};
    }
  }

  void announce(const LocalDesktop& desktop) {
    connection_.connected();
    desk_.open();
    desk_.post({Connected{"X display " + options_.display.text(), desktop.size(), {}}});
  }

  // Sleeps until there is something to do. The look at the pointer is a sign of life, too.
  void rest(const XConnection& connection, LocalDesktop& desktop) {
    connection.flush();
    const Deadline look = Clock::now() + kLookPeriod;
    const Deadline deadline = desktop.damaged() ? std::min(desktop.publishDue(), look) : look;
    std::array<pollfd, 3> watched{
        {{connection.fd(), POLLIN, 0}, {desk_.inputWaits().fd(), POLLIN, 0}, {desk_.stopped().fd(), POLLIN, 0}}};
    ::poll(watched.data(), watched.size(), millisecondsUntil(deadline));
    if (Clock::now() >= look) desktop.lookForPointer();
  }

  // From here on a session that does not end by itself can be ended.
  void hold(int socket) {
    const std::scoped_lock lock(mutex_);
    socket_ = FileDescriptor(::fcntl(socket, F_DUPFD_CLOEXEC, 0));
  }
  void cut() {
    const std::scoped_lock lock(mutex_);
    if (socket_.get() >= 0) ::shutdown(socket_.get(), SHUT_RDWR);
  }

  const LocalSessionOptions options_;
  FrameBelt& belt_;
  SessionDesk desk_;
  std::mutex mutex_;  // guards socket_
  FileDescriptor socket_;
  std::binary_semaphore finished_{0};
  // The thread's own:
  Reconnection connection_;
  std::uint64_t updates_ = 0;
  std::jthread thread_;
};

LocalSession::LocalSession(LocalSessionOptions options, FrameBelt& belt, std::function<void()> wake)
    : worker_(std::make_unique<Worker>(options, belt, std::move(wake))) {}

LocalSession::~LocalSession() = default;

std::vector<SessionEvent> LocalSession::takeEvents() {
  return worker_->desk().takeEvents();
}

void LocalSession::sendPointer(int x, int y, std::uint16_t buttons) {
  worker_->desk().add(PointerInput{x, y, buttons});
}

void LocalSession::sendKey(std::uint32_t keysym, bool down) {
  worker_->desk().add(KeyInput{keysym, down});
}

void LocalSession::sendClipboard(std::string text, Selection selection) {
  worker_->desk().add(ClipboardInput{std::move(text), selection});
}

void LocalSession::stop() {
  worker_->stop();
}

}  // namespace pixelflex::viewer
