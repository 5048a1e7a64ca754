// A user's name and password (VeNCrypt's Plain), which no server of Debian's asks for without PAM: within encryption
// only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <tuple>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support/tls_server.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::Certificates;
using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using pixelflex::testing::TlsServer;
using ::testing::HasSubstr;

constexpr std::uint32_t kTlsPlain = 259;
constexpr std::uint32_t kX509Plain = 262;
constexpr devices::Size kDesktop{20, 10};

struct PlainServer {
  std::uint32_t subType;
  const Certificates* certificates;  // null: anonymous
  std::string user = "operator";
  std::string password = "correct horse";
  std::string gotUser = {};
  std::string gotPassword = {};

  void operator()(FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(1).u8(19));
    client.receive(13);
    client.send(Message().u8(0).u8(2));
    client.receive(2);
    client.send(Message().u8(0).u8(1).u32(subType));
    client.receive(4);
    client.send(Message().u8(1));
    const TlsServer tls(client, certificates);
    readLogin(tls);
    if (gotUser != user || gotPassword != password) {
      const std::string reason = "no such user";
      return tls.send(Message().u32(1).u32(static_cast<std::uint32_t>(reason.size())).text(reason));
    }
    tls.send(Message().u32(0));
    (void)tls.receive(1);  // ClientInit
    show(tls);
    client.drain(std::chrono::seconds(20));
  }
  void readLogin(const TlsServer& tls) {
    const auto lengths = tls.receive(8);
    for (auto [text, length] : {std::pair(&gotUser, lengths[3]), std::pair(&gotPassword, lengths[7])}) {
      const auto bytes = tls.receive(length);
      text->assign(bytes.begin(), bytes.end());
    }
  }
  static void show(const TlsServer& tls) {
    const auto greeting = FakeConnection::greeting(kDesktop, "plain").bytes();
    Message init;
    for (std::size_t i = 18; i < greeting.size(); ++i) init.u8(greeting[i]);
    tls.send(init);
    tls.send(Message().update(1).rect(0, 0, kDesktop.width, kDesktop.height, 7).u8(0x80).repeat(77, 3));
  }
};

SessionOptions optionsFor(const FakeVncServer& server) {
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.user = "operator";
  options.password = "correct horse";
  return options;
}

class PlainLogin : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  [[nodiscard]] bool x509() const { return GetParam() == kX509Plain; }
  [[nodiscard]] const Certificates* certificates() const { return x509() ? &certificates_ : nullptr; }
  /// A way to know the server, where it can be known.
  void trust(SessionOptions& options) const {
    if (x509()) options.security.caFile = certificates_.authority();
  }
  Closed closedBy(PlainServer& script, const std::function<void(SessionOptions&)>& change) const {
    const FakeVncServer server(std::ref(script), FakeVncServer::Transport::kTcp);
    SessionOptions options = optionsFor(server);
    trust(options);
    change(options);
    DesktopMirror mirror(options);
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
    return mirror.last<Closed>().value_or(Closed{});
  }
  const Certificates certificates_;
};

TEST_P(PlainLogin, GivesUserAndPasswordAndShowsTheDesktop) {
  PlainServer script{GetParam(), certificates()};
  {
    const FakeVncServer server(std::ref(script), FakeVncServer::Transport::kTcp);
    SessionOptions options = optionsFor(server);
    trust(options);
    options.security.require = x509() ? SecurityLevel::kX509 : SecurityLevel::kTls;
    DesktopMirror mirror(options);
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
    EXPECT_EQ(mirror.desktop().at(19, 9, 1), 77);
    EXPECT_EQ(mirror.last<Connected>()->security.level, options.security.require);
  }
  EXPECT_EQ(script.gotUser, "operator");
  EXPECT_EQ(script.gotPassword, "correct horse") << "all of it, not eight letters";
}

TEST_P(PlainLogin, SaysThatTheServerRefuses) {
  PlainServer script{GetParam(), certificates()};
  const Closed closed = closedBy(script, [](SessionOptions& options) { options.password = "wrong"; });
  EXPECT_EQ(closed.kind, CloseKind::kAuthentication);
  EXPECT_THAT(closed.message, HasSubstr("refused the password (it says: no such user)"));
  EXPECT_EQ(script.gotPassword, "wrong");
}

TEST_P(PlainLogin, AsksForWhatIsMissing) {
  PlainServer nobody{GetParam(), certificates()};
  const Closed unnamed = closedBy(nobody, [](SessionOptions& options) { options.user.clear(); });
  EXPECT_EQ(unnamed.kind, CloseKind::kPasswordNeeded);
  EXPECT_THAT(unnamed.message, HasSubstr("--user"));
  PlainServer unproven{GetParam(), certificates()};
  const Closed silent = closedBy(unproven, [](SessionOptions& options) { options.password.reset(); });
  EXPECT_EQ(silent.kind, CloseKind::kPasswordNeeded);
  EXPECT_THAT(silent.message, HasSubstr("--password-file"));
  EXPECT_EQ(nobody.gotPassword + unproven.gotUser, "");
}

INSTANTIATE_TEST_SUITE_P(BothKinds, PlainLogin, ::testing::Values(kTlsPlain, kX509Plain),
                         [](const auto& kind) { return kind.param == kTlsPlain ? "Tls" : "X509"; });

TEST(PlainLoginOfAnother, GoesToNobodyWhoseCertificateIsNotTheServers) {
  const Certificates theirs;
  const Certificates another;
  PlainServer script{kX509Plain, &theirs};
  {
    const FakeVncServer server(std::ref(script), FakeVncServer::Transport::kTcp);
    SessionOptions options = optionsFor(server);
    options.security.caFile = another.authority();
    DesktopMirror mirror(options);
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
    EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kUntrusted) << mirror.last<Closed>()->message;
  }
  EXPECT_EQ(script.gotUser + script.gotPassword, "");
}

}  // namespace
}  // namespace pixelflex::viewer
