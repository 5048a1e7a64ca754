#include "viewer/vnc/session.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <deque>
#include <iterator>
#include <thread>
#include <utility>

#include "viewer/tiles/thread_time.h"
#include "viewer/vnc/connector.h"
#include "viewer/vnc/link_watch.h"
#include "viewer/vnc/liveness.h"
#include "viewer/vnc/reconnection.h"
#include "viewer/vnc/rfb_client.h"
#include "viewer/vnc/session_desk.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// A host that was there once answers within this if it is there again; one that comes back meanwhile must not wait for
// the next of the kernel's own, ever rarer attempts, of which the second would come after a second.
constexpr std::chrono::milliseconds kReconnectTimeout{950};

// libvncclient writes without MSG_NOSIGNAL. The signal goes to the thread that writes, so blocking it here leaves the
// program's own handling of SIGPIPE alone.
void blockSigpipe() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

bool takesMore(int socket) {
  pollfd watched{socket, POLLOUT, 0};
  return ::poll(&watched, 1, 0) > 0;
}

}  // namespace

class Session::Worker {
 public:
  Worker(SessionOptions options, FrameBelt& belt, std::function<void()> wake)
      : mayResize_(options.mayResize && !options.viewOnly),
        options_(std::move(options)),
        belt_(belt),
        desk_(!options_.viewOnly, std::move(wake)),
        connection_(options_.retry, "the session with " + describeServer(options_.server), desk_) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      blockSigpipe();
      connection_.run(stop, [&] { talk(stop); });
    });
  }
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  SessionDesk& desk() { return desk_; }

  bool requestLayout(ScreenLayout layout) {
    if (!mayResize_) return false;
    desk_.add(LayoutInput{std::move(layout)});
    return true;
  }

  void stop() {
    thread_.request_stop();
    desk_.stop();
  }

 private:
  [[noreturn]] void talk(const std::stop_token& stop) {
    const auto patience =
        connection_.lost() ? std::min(kReconnectTimeout, options_.connectTimeout) : options_.connectTimeout;
    const int socket = desk_.adopt(
        connectToServer(options_.server, {.lookUp = options_.connectTimeout, .connect = patience}, desk_.stopped()));
    LinkWatch link(socket, options_);
    RfbClient client(socket, options_, link.settings());
    client.handshake(Clock::now() + options_.connectTimeout, desk_.stopped());
    unsent_.clear();
    requireNoLess(client.security().level);
    announce(client);
    Liveness liveness(3 * options_.patience, Clock::now());
    while (true) {
      sendInput(client, socket);
      if (!client.hasBufferedBytes() && !waitForServer(client, socket, liveness)) continue;
      if (receive(client, link, stop)) liveness = Liveness(options_.patience, Clock::now());
      liveness.heard(Clock::now());
    }
  }

  // Whoever takes an encrypted server's place may not do so in the clear.
  void requireNoLess(SecurityLevel level) {
    if (level >= SecurityLevel::kTls) options_.security.require = std::max(options_.security.require, level);
  }

  void announce(const RfbClient& client) {
    connection_.connected();
    desk_.open();
    desk_.post({Connected{client.desktopName(), client.desktop(), client.security()}});
  }

  // Sleeps until the server speaks (true) or something is to be done for it.
  bool waitForServer(RfbClient& client, int socket, Liveness& liveness) {
    const bool clogged = !unsent_.empty();
    const int input = clogged ? -1 : desk_.inputWaits().fd();
    const auto events = static_cast<short>(clogged ? POLLIN | POLLOUT : POLLIN);
    std::array<pollfd, 3> watched{{{socket, events, 0}, {input, POLLIN, 0}, {desk_.stopped().fd(), POLLIN, 0}}};
    const int ready = ::poll(watched.data(), watched.size(), millisecondsUntil(liveness.due()));
    if (ready > 0 && watched[2].revents != 0) throw SessionStopped{};
    if (ready > 0) return (watched[0].revents & ~POLLOUT) != 0;
    const auto verdict = liveness.judge(Clock::now());
    if (verdict == Liveness::Verdict::kAsk && takesMore(socket)) client.askForSignOfLife();
    if (verdict == Liveness::Verdict::kGone) client.giveUp();
    return false;
  }

  // A server that takes nothing more must not keep this thread from reading, or both would wait for ever.
  void sendInput(RfbClient& client, int socket) {
    if (unsent_.empty()) std::ranges::move(desk_.takeInput(), std::back_inserter(unsent_));
    while (!unsent_.empty() && takesMore(socket)) {
      client.send(unsent_.front());
      unsent_.pop_front();
    }
  }

  // True when a whole update came.
  bool receive(RfbClient& client, LinkWatch& link, const std::stop_token& stop) {
    const auto received = Clock::now();
    const auto before = threadTime();
    link.before();
    client.handleMessage();
    const auto decoding = threadTime() - before;
    if (auto words = link.after(client, Clock::now() - received - decoding))
      desk_.post({LinkChanged{*std::move(words)}});
    if (options_.claimPointer && !options_.viewOnly) client.claimPointer();
    desk_.post(client.takeEvents());
    std::optional<Region> damage = client.takeFinishedUpdate();
    if (!damage) return false;
    if (damage->empty()) return true;
    const Update update{++updates_, received, *std::move(damage), decoding};
    if (!publishUpdate(client.frame(), update, belt_, stop)) throw SessionStopped{};
    return true;
  }

  const bool mayResize_;
  SessionOptions options_;  // the thread's own once it runs
  FrameBelt& belt_;
  SessionDesk desk_;
  // The thread's own:
  Reconnection connection_;
  std::uint64_t updates_ = 0;
  std::deque<Input> unsent_;
  std::jthread thread_;
};

Session::Session(SessionOptions options, FrameBelt& belt, std::function<void()> wake)
    : worker_(std::make_unique<Worker>(std::move(options), belt, std::move(wake))) {}

Session::~Session() = default;

std::vector<SessionEvent> Session::takeEvents() {
  return worker_->desk().takeEvents();
}

void Session::sendPointer(int x, int y, std::uint16_t buttons) {
  worker_->desk().add(PointerInput{x, y, buttons});
}

void Session::sendKey(std::uint32_t keysym, bool down) {
  worker_->desk().add(KeyInput{keysym, down});
}

void Session::sendClipboard(std::string text, Selection selection) {
  worker_->desk().add(ClipboardInput{std::move(text), selection});
}

bool Session::requestLayout(ScreenLayout layout) {
  return worker_->requestLayout(std::move(layout));
}

void Session::stop() {
  worker_->stop();
}

}  // namespace pixelflex::viewer
