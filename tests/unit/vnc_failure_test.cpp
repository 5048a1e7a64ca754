#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support/free_port.h"
#include "tests/support/x_servers.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using pixelflex::testing::TemporaryFolder;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

Closed closedBy(const SessionOptions& options) {
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  return mirror.last<Closed>().value_or(Closed{});
}

SessionOptions optionsFor(const std::string& address) {
  SessionOptions options;
  options.server = parseServerAddress(address);
  options.connectTimeout = milliseconds(5000);
  return options;
}

Closed closedBy(const FakeVncServer& server) {
  return closedBy(optionsFor(server.address()));
}

// A TCP port of 127.0.0.1 that neither accepts nor refuses: its queue of waiting clients is full.
class SilentPort {
 public:
  SilentPort() {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address_;
    EXPECT_EQ(::bind(listener_, generic(), length), 0);
    EXPECT_EQ(::listen(listener_, 0), 0);
    EXPECT_EQ(::getsockname(listener_, generic(), &length), 0);
    for (int& waiting : waiting_) {
      waiting = newSocket();
      (void)::connect(waiting, generic(), length);
    }
    std::this_thread::sleep_for(milliseconds(20));
  }
  ~SilentPort() {
    for (const int waiting : waiting_) ::close(waiting);
    ::close(listener_);
  }
  SilentPort(const SilentPort&) = delete;
  SilentPort& operator=(const SilentPort&) = delete;

  [[nodiscard]] std::string address() const { return "127.0.0.1::" + std::to_string(ntohs(address_.sin_port)); }

 private:
  static int newSocket() { return ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }
  sockaddr* generic() { return reinterpret_cast<sockaddr*>(&address_); }

  sockaddr_in address_{};
  int listener_ = newSocket();
  int waiting_[4] = {};
};

TEST(SessionFailure, NamesAHostThatDoesNotExist) {
  const Closed closed = closedBy(optionsFor("no-such-host.invalid:1"));
  EXPECT_EQ(closed.kind, CloseKind::kUnreachable);
  EXPECT_THAT(closed.message, HasSubstr("host no-such-host.invalid"));
}

TEST(SessionFailure, SaysThatNothingListens) {
  const int port = pixelflex::testing::freePort();
  const Closed closed = closedBy(optionsFor("127.0.0.1::" + std::to_string(port)));
  EXPECT_EQ(closed.kind, CloseKind::kUnreachable);
  EXPECT_EQ(closed.message, "nothing listens at 127.0.0.1 port " + std::to_string(port) + ": is the server running?");
}

TEST(SessionFailure, GivesUpOnAHostThatDoesNotAnswer) {
  const SilentPort port;
  SessionOptions options = optionsFor(port.address());
  options.connectTimeout = milliseconds(300);
  const auto begin = std::chrono::steady_clock::now();
  const Closed closed = closedBy(options);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8)) << "ten are usual";
  EXPECT_EQ(closed.kind, CloseKind::kUnreachable);
  EXPECT_THAT(closed.message, HasSubstr("no answer from 127.0.0.1 port"));
  EXPECT_THAT(closed.message, HasSubstr("within 0.3 s"));
}

TEST(SessionFailure, StopsAtOnceWhileConnecting) {
  const SilentPort port;
  auto mirror = std::make_unique<DesktopMirror>(port.address());
  mirror->pumpFor(milliseconds(50));
  const auto begin = std::chrono::steady_clock::now();
  mirror.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8)) << "ten are usual";
}

TEST(SessionFailure, ExplainsUnixSockets) {
  const TemporaryFolder folder;
  const std::string missing = (folder / "missing.sock").string();
  EXPECT_EQ(closedBy(optionsFor("unix:" + missing)),
            (Closed{CloseKind::kUnreachable, "there is no socket " + missing + ": is the server running?"}));

  const std::string file = (folder / "file").string();
  std::ofstream(file) << "not a socket";
  EXPECT_THAT(closedBy(optionsFor("unix:" + file)).message, HasSubstr(file + " is not a socket"));

  std::string stale;
  {
    stale = FakeVncServer([](FakeConnection&) {}).address();
  }
  EXPECT_THAT(closedBy(optionsFor(stale)).message, HasSubstr("is the server running?"));

  const std::string path = "/" + std::string(200, 'x');
  EXPECT_THAT(closedBy(optionsFor("unix:" + path)).message, HasSubstr("too long"));
}

TEST(SessionFailure, ExplainsADeadUnixSocket) {
  const TemporaryFolder folder;
  const std::string path = (folder / "dead.sock").string();
  // A server that was killed leaves its socket file behind.
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(socket);
  ASSERT_TRUE(std::filesystem::exists(path));
  EXPECT_EQ(closedBy(optionsFor("unix:" + path)).message,
            "nothing listens at the socket " + path + ": is the server running?");
}

TEST(SessionFailure, RecognisesWhatIsNotAVncServer) {
  for (const auto transport : {FakeVncServer::Transport::kUnix, FakeVncServer::Transport::kTcp}) {
    const FakeVncServer web([](FakeConnection& c) { c.send(Message().text("HTTP/1.1 400 Bad Request\r\n\r\n")); },
                            transport);
    const Closed closed = closedBy(web);
    EXPECT_EQ(closed.kind, CloseKind::kNotVnc);
    EXPECT_THAT(closed.message, HasSubstr("is not a VNC server (it begins with \"HTTP/1.1 400\"): check the port"));
  }
}

TEST(SessionFailure, GivesUpOnASilentServer) {
  const FakeVncServer server([](FakeConnection& client) { client.drain(std::chrono::seconds(20)); });
  SessionOptions options = optionsFor(server.address());
  options.connectTimeout = milliseconds(200);
  const Closed closed = closedBy(options);
  EXPECT_EQ(closed.kind, CloseKind::kUnreachable);
  EXPECT_THAT(closed.message, HasSubstr("accepts connections but says nothing"));
}

TEST(SessionFailure, GivesUpOnAServerThatStopsInTheHandshake) {
  const FakeVncServer server([](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(1).u8(1));
    client.drain(std::chrono::seconds(20));
  });
  SessionOptions options = optionsFor(server.address());
  options.connectTimeout = milliseconds(200);
  const Closed closed = closedBy(options);
  EXPECT_EQ(closed.kind, CloseKind::kUnreachable);
  EXPECT_THAT(closed.message, HasSubstr("stopped answering"));
}

TEST(SessionFailure, SaysWhenTheServerHangsUp) {
  const FakeVncServer early([](FakeConnection& client) { client.send(Message().text("RFB 003.008\n").u8(1)); });
  Closed closed = closedBy(early);
  EXPECT_EQ(closed.kind, CloseKind::kLost);
  EXPECT_THAT(closed.message, HasSubstr("closed the connection during the handshake"));

  const FakeVncServer inside([](FakeConnection& client) {
    client.shakeHands({16, 16});
    client.send(Message().update(1).rect(0, 0, 16, 16, 0).repeat(0, 99));
  });
  closed = closedBy(inside);
  EXPECT_EQ(closed.kind, CloseKind::kLost);
  EXPECT_THAT(closed.message, HasSubstr("closed the connection in the middle of an update"));

  const FakeVncServer between([](FakeConnection& client) { client.shakeHands({16, 16}); });
  closed = closedBy(between);
  EXPECT_EQ(closed.kind, CloseKind::kLost);
  EXPECT_THAT(closed.message, ::testing::EndsWith("closed the connection"));
}

FakeVncServer::Script asksForPassword(const std::string& answer) {
  return [answer](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(1).u8(2));
    client.receive(13);
    client.send(Message().repeat(0x5a, 16));
    client.receive(16);
    client.send(Message().u32(1).u32(static_cast<std::uint32_t>(answer.size())).text(answer));
  };
}

TEST(SessionFailure, AsksForAPassword) {
  const FakeVncServer server(asksForPassword("no"));
  const Closed closed = closedBy(server);
  EXPECT_EQ(closed.kind, CloseKind::kPasswordNeeded);
  EXPECT_THAT(closed.message, HasSubstr("asks for a password: give it with --password-file"));
}

TEST(SessionFailure, ReportsAWrongPassword) {
  const FakeVncServer server(asksForPassword("Authentication failure"));
  SessionOptions options = optionsFor(server.address());
  options.password = "wrong";
  const Closed closed = closedBy(options);
  EXPECT_EQ(closed.kind, CloseKind::kAuthentication);
  EXPECT_THAT(closed.message, HasSubstr("refused the password (it says: Authentication failure)"));
}

TEST(SessionFailure, ReportsWhatTheServerSaysWhenItRefuses) {
  const FakeVncServer server([](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(0).u32(26).text("Too many security failures"));
  });
  const Closed closed = closedBy(server);
  EXPECT_EQ(closed.kind, CloseKind::kAuthentication);
  EXPECT_THAT(closed.message, HasSubstr("refused the connection (it says: Too many security failures)"));
}

TEST(SessionFailure, ReportsUnknownSecurityTypes) {
  const FakeVncServer server(
      [](FakeConnection& client) { client.send(Message().text("RFB 003.008\n").u8(2).u8(30).u8(18)); });
  const Closed closed = closedBy(server);
  EXPECT_EQ(closed.kind, CloseKind::kUntrusted);
  EXPECT_THAT(closed.message, HasSubstr("offers 30, 18 and no security type known here"));
  EXPECT_THAT(closed.message, HasSubstr("SecurityTypes X509Vnc, TLSVnc, VncAuth or None"));
}

TEST(SessionFailure, RefusesDesktopsThatAreTooLarge) {
  const FakeVncServer wide([](FakeConnection& client) { client.shakeHands({20000, 1000}); });
  EXPECT_EQ(closedBy(wide),
            (Closed{CloseKind::kTooLarge,
                    "the server's desktop is 20000x1000; at most 16384x16384 is supported; start it with a smaller "
                    "-geometry"}));
  const FakeVncServer huge([](FakeConnection& client) { client.shakeHands({65535, 65535}); });
  EXPECT_EQ(closedBy(huge).kind, CloseKind::kTooLarge);
  const FakeVncServer grown([](FakeConnection& client) {
    client.shakeHands({800, 600});
    client.send(Message().update(1).rect(0, 0, 16385, 600, -223));
  });
  EXPECT_EQ(closedBy(grown).kind, CloseKind::kTooLarge);
}

}  // namespace
}  // namespace pixelflex::viewer
