#include "viewer/vnc/session.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <csignal>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include "viewer/vnc/connector.h"
#include "viewer/vnc/input_queue.h"
#include "viewer/vnc/rfb_client.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

// libvncclient writes without MSG_NOSIGNAL. The signal goes to the thread that writes, so blocking it here leaves the
// program's own handling of SIGPIPE alone.
void blockSigpipe() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

}  // namespace

class Session::Worker {
 public:
  Worker(SessionOptions options, FrameBelt& belt, std::function<void()> wake)
      : options_(std::move(options)), belt_(belt), wake_(std::move(wake)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  std::vector<SessionEvent> takeEvents() {
    const std::lock_guard lock(mutex_);
    return std::exchange(events_, {});
  }

  void add(Input input) {
    {
      const std::lock_guard lock(mutex_);
      if (!connected_ || options_.viewOnly) return;
      input_.add(std::move(input));
    }
    inputWaits_.raise();
  }

  void stop() {
    thread_.request_stop();
    stopped_.raise();
    const std::lock_guard lock(mutex_);
    connected_ = false;
    // Ends whatever read or write libvncclient is in.
    if (socket_.get() >= 0) ::shutdown(socket_.get(), SHUT_RDWR);
  }

 private:
  void run(const std::stop_token& stop) {
    blockSigpipe();
    try {
      converse(stop);
    } catch (const SessionStopped&) {
    } catch (const SessionError& error) {
      close({error.kind(), error.what()}, stop);
    } catch (const std::exception& error) {
      close({CloseKind::kLost, "the session with " + describeServer(options_.server) + " ended: " + error.what()},
            stop);
    }
    closeSocket();
  }

  void converse(const std::stop_token& stop) {
    const int socket = adopt(connectToServer(options_.server, options_.connectTimeout, stopped_), stop);
    RfbClient client(socket, options_);
    client.handshake(std::chrono::steady_clock::now() + options_.connectTimeout, stopped_);
    announce(client, stop);
    while (true) {
      sendInput(client);
      if (!client.hasBufferedBytes() && !waitForServer(socket)) continue;
      receive(client, stop);
    }
  }

  // From here on stop() can reach the socket.
  int adopt(FileDescriptor socket, const std::stop_token& stop) {
    const std::lock_guard lock(mutex_);
    if (stop.stop_requested()) throw SessionStopped{};
    socket_ = std::move(socket);
    return socket_.get();
  }

  void closeSocket() {
    const std::lock_guard lock(mutex_);
    connected_ = false;
    socket_ = FileDescriptor();
  }

  void announce(RfbClient& client, const std::stop_token& stop) {
    {
      const std::lock_guard lock(mutex_);
      connected_ = !stop.stop_requested();
    }
    post({Connected{client.desktopName(), client.desktop()}});
  }

  // Sleeps until the server speaks (true) or there is input to send.
  bool waitForServer(int socket) {
    bool serverSpeaks = false;
    while (!serverSpeaks) {
      std::array<pollfd, 3> watched{{{socket, POLLIN, 0}, {inputWaits_.fd(), POLLIN, 0}, {stopped_.fd(), POLLIN, 0}}};
      if (::poll(watched.data(), watched.size(), -1) < 0) continue;
      if (watched[2].revents != 0) throw SessionStopped{};
      if (watched[1].revents != 0) return false;
      serverSpeaks = watched[0].revents != 0;
    }
    return true;
  }

  void sendInput(RfbClient& client) {
    inputWaits_.clear();
    std::vector<Input> waiting;
    {
      const std::lock_guard lock(mutex_);
      waiting = input_.takeAll();
    }
    for (const Input& input : waiting) client.send(input);
  }

  void receive(RfbClient& client, const std::stop_token& stop) {
    const auto received = std::chrono::steady_clock::now();
    client.handleMessage();
    if (options_.claimPointer && !options_.viewOnly) client.claimPointer();
    post(client.takeEvents());
    std::optional<Region> damage = client.takeFinishedUpdate();
    if (!damage || damage->empty()) return;
    const Update update{++updates_, received, *std::move(damage)};
    if (!publishUpdate(client.frame(), update, belt_, stop)) throw SessionStopped{};
  }

  void post(std::vector<SessionEvent> events) {
    if (events.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      std::move(events.begin(), events.end(), std::back_inserter(events_));
    }
    if (wake_) wake_();
  }

  void close(Closed closed, const std::stop_token& stop) {
    if (!stop.stop_requested()) post({std::move(closed)});
  }

  const SessionOptions options_;
  FrameBelt& belt_;
  const std::function<void()> wake_;
  Signal stopped_;
  Signal inputWaits_;
  std::uint64_t updates_ = 0;  // the thread's own
  std::mutex mutex_;           // guards what follows
  bool connected_ = false;
  FileDescriptor socket_;
  InputQueue input_;
  std::vector<SessionEvent> events_;
  std::jthread thread_;
};

Session::Session(SessionOptions options, FrameBelt& belt, std::function<void()> wake)
    : worker_(std::make_unique<Worker>(std::move(options), belt, std::move(wake))) {}

Session::~Session() = default;

std::vector<SessionEvent> Session::takeEvents() {
  return worker_->takeEvents();
}

void Session::sendPointer(int x, int y, std::uint8_t buttons) {
  worker_->add(PointerInput{x, y, buttons});
}

void Session::sendKey(std::uint32_t keysym, bool down) {
  worker_->add(KeyInput{keysym, down});
}

void Session::sendClipboard(std::string text) {
  worker_->add(ClipboardInput{std::move(text)});
}

void Session::stop() {
  worker_->stop();
}

}  // namespace pixelflex::viewer
