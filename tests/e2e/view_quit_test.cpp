#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <future>
#include <stdexcept>

#include "tests/e2e/view_lost.h"
#include "tests/support/fake_vnc_server.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A port of 127.0.0.1 whose queue of connections is full: whoever connects waits for an answer.
class FullListener {
 public:
  FullListener() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address_;
    if (::bind(listener_, asGeneric(), length) != 0 || ::listen(listener_, 0) != 0 ||
        ::getsockname(listener_, asGeneric(), &length) != 0) {
      throw std::runtime_error("cannot listen");
    }
    for (int& client : clients_) {
      client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
      (void)::connect(client, asGeneric(), length);
    }
  }
  ~FullListener() {
    for (const int client : clients_) ::close(client);
    ::close(listener_);
  }
  FullListener(const FullListener&) = delete;
  FullListener& operator=(const FullListener&) = delete;
  [[nodiscard]] std::string address() const { return "127.0.0.1::" + std::to_string(ntohs(address_.sin_port)); }

 private:
  sockaddr* asGeneric() { return reinterpret_cast<sockaddr*>(&address_); }
  int listener_;
  sockaddr_in address_{};
  std::array<int, 3> clients_{};
};

class QuitTest : public LostTest {
 protected:
  void expectQuickEnd(Process& viewer, int signal) const {
    ASSERT_TRUE(viewer.running()) << log();
    const auto begin = Clock::now();
    viewer.signal(signal);
    EXPECT_EQ(viewer.wait(20s), 0) << log();
    EXPECT_LT(Clock::now() - begin, 5s);
  }
  /// Where the state gives no sign that it is reached: long enough for it on a resting machine.
  static void settle() { std::this_thread::sleep_for(700ms); }
};

TEST_F(QuitTest, WhileConnecting) {
  const FullListener server;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const auto viewer = startViewer({}, server.address());
    settle();
    expectQuickEnd(*viewer, signal);
  }
}

TEST_F(QuitTest, InTheHandshake) {
  std::promise<void> reached;
  const FakeVncServer server([&](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n"));
    client.receive(12);
    reached.set_value();
    client.drain(30s);
  });
  const auto viewer = startViewer({}, server.address());
  reached.get_future().wait();
  expectQuickEnd(*viewer, SIGTERM);
}

TEST_F(QuitTest, InTheMiddleOfAnUpdate) {
  std::promise<void> reached;
  const FakeVncServer server([&](FakeConnection& client) {
    client.shakeHands({640, 240});
    client.send(Message().update(1).rect(0, 0, 640, 240, 0).repeat(7, 1000));
    reached.set_value();
    client.drain(30s);
  });
  const auto viewer = startViewer({}, server.address());
  reached.get_future().wait();
  expectQuickEnd(*viewer, SIGHUP);
}

TEST_F(QuitTest, WhileTheServerIsAwayOrStalled) {
  auto server = startServer();
  auto viewer = startViewer({"--stats"});
  waitFor("stats:", 1);
  server->process().signal(SIGSTOP);
  expectQuickEnd(*viewer, SIGINT);
  server.reset();
  server = startServer();
  viewer = startViewer({"--stats"});
  waitFor("stats:", 1);
  server->process().signal(SIGKILL);
  waitFor(kLost, 1);
  expectQuickEnd(*viewer, SIGTERM);
  viewer = startViewer({"--retry", "always"});
  waitFor(kLost, 1);
  expectQuickEnd(*viewer, SIGHUP);
}

}  // namespace
}  // namespace pixelflex::testing
