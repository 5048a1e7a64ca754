// Security of sessions with TigerVNC's server: every type that it offers, and every refusal.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/certificates.h"
#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::Certificates;
using pixelflex::testing::DesktopMirror;
using pixelflex::testing::TemporaryFolder;
using pixelflex::testing::XvncOptions;
using pixelflex::testing::XvncServer;
using ::testing::HasSubstr;
using ::testing::Not;

XvncOptions secured(const std::string& types, const Certificates* certificates = nullptr) {
  XvncOptions options{.size = {320, 240}, .unixSocket = true, .tcp = true, .password = "sesame"};
  options.more = {"-SecurityTypes", types};
  if (certificates != nullptr) {
    options.more.insert(options.more.end(),
                        {"-X509Cert", certificates->certificate(), "-X509Key", certificates->key()});
  }
  return options;
}

SessionOptions optionsFor(const std::string& address) {
  SessionOptions options;
  options.server = parseServerAddress(address);
  options.password = "sesame";
  return options;
}

// The session's end, or its security once it has shown a picture.
struct Outcome {
  std::optional<Connected> connected;
  Closed closed;
};

Outcome outcomeOf(const SessionOptions& options) {
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>() || mirror.updates() > 0; })) << mirror.summary();
  Outcome outcome;
  if (mirror.updates() > 0) outcome.connected = mirror.last<Connected>();
  outcome.closed = mirror.last<Closed>().value_or(Closed{});
  return outcome;
}

void expectLevel(const SessionOptions& options, SecurityLevel level) {
  const Outcome outcome = outcomeOf(options);
  ASSERT_TRUE(outcome.connected.has_value()) << outcome.closed.message;
  EXPECT_EQ(outcome.connected->security.level, level);
}

void expectUntrusted(const SessionOptions& options, const std::string& says) {
  const Outcome outcome = outcomeOf(options);
  EXPECT_FALSE(outcome.connected.has_value());
  EXPECT_EQ(outcome.closed.kind, CloseKind::kUntrusted) << outcome.closed.message;
  EXPECT_THAT(outcome.closed.message, HasSubstr(says));
}

TEST(XvncSecurity, TakesTheBestOfWhatIsOffered) {
  const Certificates certificates;
  const struct {
    const char* types;
    SecurityLevel level;
  } cases[] = {{"None", SecurityLevel::kNone},        {"VncAuth", SecurityLevel::kVnc},
               {"TLSNone", SecurityLevel::kTls},      {"TLSVnc", SecurityLevel::kTls},
               {"X509None", SecurityLevel::kX509},    {"X509Vnc", SecurityLevel::kX509},
               {"None,VncAuth", SecurityLevel::kVnc}, {"VncAuth,TLSVnc,X509Vnc", SecurityLevel::kX509}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.types);
    const XvncServer server(secured(one.types, &certificates));
    SessionOptions options = optionsFor(server.tcpAddress());
    options.security.caFile = certificates.authority();
    expectLevel(options, one.level);
  }
}

TEST(XvncSecurity, ShowsAnEncryptedDesktopBitForBit) {
  const Certificates certificates;
  for (const char* types : {"TLSVnc", "X509Vnc"}) {
    SCOPED_TRACE(types);
    XvncOptions server = secured(types, &certificates);
    server.size = {1600, 1200};
    XvncServer xvnc(server);
    SessionOptions options = optionsFor(xvnc.tcpAddress());
    options.security.caFile = certificates.authority();
    DesktopMirror mirror(options);
    xvnc.x().start({"xterm", "-geometry", "200x60+0+0", "-e", "sh", "-c", "seq 1 5000; sleep 1000"});
    xvnc.x().query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
    xvnc.x().query({"xsetroot", "-mod", "16", "12", "-fg", "steel blue", "-bg", "wheat"});
    ASSERT_TRUE(mirror.pumpUntilEqual(xvnc.x().display())) << mirror.summary();
    mirror.session().sendPointer(123, 234, 0);
    EXPECT_TRUE(mirror.pumpUntil([&] {
      return xvnc.x().query({"xdotool", "getmouselocation"}).starts_with("x:123 y:234 ");
    }));
    xvnc.x().process().signal(SIGKILL);
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); }));
    EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kLost) << mirror.summary();
    EXPECT_THAT(mirror.summary(), HasSubstr("closed the connection"));
  }
}

TEST(XvncSecurity, WorksOverAUnixSocketToo) {
  const Certificates certificates;
  const XvncServer server(secured("X509Vnc", &certificates));
  SessionOptions options = optionsFor(server.unixAddress());
  options.security.caFile = certificates.authority();
  expectLevel(options, SecurityLevel::kX509);
}

TEST(XvncSecurity, RefusesAWrongPassword) {
  const Certificates certificates;
  for (const char* types : {"VncAuth", "TLSVnc", "X509Vnc"}) {
    SCOPED_TRACE(types);
    const XvncServer server(secured(types, &certificates));
    SessionOptions options = optionsFor(server.tcpAddress());
    options.security.caFile = certificates.authority();
    options.password = "wrong";
    const Outcome outcome = outcomeOf(options);
    EXPECT_EQ(outcome.closed.kind, CloseKind::kAuthentication);
    EXPECT_THAT(outcome.closed.message, HasSubstr("refused the password"));
    options.password.reset();
    EXPECT_EQ(outcomeOf(options).closed.kind, CloseKind::kPasswordNeeded);
  }
}

TEST(XvncSecurity, RefusesWhatIsBelowTheRequiredLevel) {
  const Certificates certificates;
  const struct {
    const char* types;
    SecurityLevel require;
  } cases[] = {
      {"None", SecurityLevel::kVnc}, {"VncAuth", SecurityLevel::kTls}, {"TLSVnc,VncAuth,None", SecurityLevel::kX509}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.types);
    const XvncServer server(secured(one.types, &certificates));
    SessionOptions options = optionsFor(server.tcpAddress());
    options.security.require = one.require;
    expectUntrusted(options, std::string("below the level ") + nameOf(one.require));
    options.security.require = static_cast<SecurityLevel>(static_cast<int>(one.require) - 1);
    expectLevel(options, options.security.require);
  }
}

TEST(XvncSecurity, ChecksTheCertificateAgainstTheGivenAuthority) {
  const Certificates certificates;
  const Certificates others;
  const XvncServer server(secured("X509Vnc", &certificates));
  SessionOptions options = optionsFor(server.tcpAddress());
  options.security.caFile = others.authority();
  expectUntrusted(options, "not trusted by " + others.authority());
  options.security.caFile = certificates.key();
  expectUntrusted(options, "holds no certificate");
  options.security.caFile = "/nowhere/ca.pem";
  expectUntrusted(options, "/nowhere/ca.pem");
  options.security.caFile.clear();
  expectUntrusted(options, certificates.fingerprint());  // nothing is remembered, so nothing is trusted on first use
}

TEST(XvncSecurity, ChecksTheNameInTheCertificate) {
  const Certificates certificates("DNS:wall.example");
  const XvncServer server(secured("X509Vnc", &certificates));
  SessionOptions options = optionsFor(server.tcpAddress());
  options.security.caFile = certificates.authority();
  expectUntrusted(options, "not for the name 127.0.0.1");
}

TEST(XvncSecurity, TakesAFingerprint) {
  const Certificates certificates;
  const XvncServer server(secured("X509Vnc", &certificates));
  SessionOptions options = optionsFor(server.tcpAddress());
  options.security.require = SecurityLevel::kX509;
  options.security.fingerprint = "SHA256:" + certificates.fingerprint();
  expectLevel(options, SecurityLevel::kX509);
  options.security.fingerprint.back() = options.security.fingerprint.back() == '0' ? '1' : '0';
  expectUntrusted(options, certificates.fingerprint());
}

std::string contentOf(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A server that starts with one certificate and then, at the same address, with another one or none.
class TrustOnFirstUse : public ::testing::Test {
 protected:
  void start(const std::string& types, const Certificates& certificates) {
    server_.reset();
    XvncOptions options = secured(types, &certificates);
    options.tcp = false;
    options.unixSocket = false;
    options.more.insert(options.more.end(), {"-rfbunixpath", socket_});
    server_ = std::make_unique<XvncServer>(options);
  }
  [[nodiscard]] SessionOptions options() const {
    SessionOptions options = optionsFor("unix:" + socket_);
    options.security.knownServersFile = known_;
    return options;
  }

  const TemporaryFolder folder_;
  const std::string socket_ = (folder_ / "wall.sock").string();
  const std::string known_ = (folder_ / "config/known_servers").string();
  std::unique_ptr<XvncServer> server_;
};

TEST_F(TrustOnFirstUse, RemembersACertificateAndRefusesAnother) {
  const Certificates first;
  start("X509Vnc", first);
  SessionOptions strict = options();
  strict.security.require = SecurityLevel::kX509;
  expectUntrusted(strict, "is not known");
  EXPECT_FALSE(std::filesystem::exists(known_));

  EXPECT_EQ(outcomeOf(options()).connected.value_or(Connected{}).security,
            (ConnectionSecurity{SecurityLevel::kX509, first.fingerprint()}));
  EXPECT_THAT(contentOf(known_), HasSubstr("unix:" + socket_ + " SHA256:" + first.fingerprint() + "\n"));
  struct stat info {};
  ASSERT_EQ(::stat(known_.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
  EXPECT_EQ(outcomeOf(strict).connected.value_or(Connected{}).security, (ConnectionSecurity{SecurityLevel::kX509, {}}));

  const std::string remembered = contentOf(known_);
  const Certificates second;
  start("X509Vnc", second);
  expectUntrusted(options(), "HAS CHANGED");
  expectUntrusted(options(), "remove the line of unix:" + socket_ + " from " + known_);
  start("TLSVnc,VncAuth,None", second);
  expectUntrusted(options(), "NOW OFFERS NONE");
  EXPECT_EQ(contentOf(known_), remembered);

  start("X509Vnc", second);
  SessionOptions told = options();
  told.security.fingerprint = second.fingerprint();
  expectLevel(told, SecurityLevel::kX509);
  expectLevel(options(), SecurityLevel::kX509);
  EXPECT_THAT(contentOf(known_), Not(HasSubstr(first.fingerprint())));
}

}  // namespace
}  // namespace pixelflex::viewer
