#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/known_servers.h"
#include "viewer/vnc/security_types.h"
#include "viewer/vnc/vnc_auth.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using pixelflex::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

TEST(SecurityLevel, IsReadAndWritten) {
  for (const char* name : {"none", "vnc", "tls", "x509"}) EXPECT_STREQ(nameOf(parseSecurityLevel(name)), name);
  for (const char* wrong : {"", "TLS", "x5090", "any"})
    EXPECT_THROW((void)parseSecurityLevel(wrong), std::invalid_argument);
}

std::uint32_t chosen(std::vector<std::uint32_t> offered, SecurityLevel require = SecurityLevel::kNone,
                     bool user = false) {
  const SecurityType* type = chooseSecurityType(offered, require, user);
  return type == nullptr ? 0 : type->number;
}

TEST(SecurityTypes, BestLevelFirst) {
  EXPECT_EQ(chosen({1, 2}), kVncAuthType);
  EXPECT_EQ(chosen({2, 258, 1}), kTlsVncType);
  EXPECT_EQ(chosen({258, 261, 257}), kX509VncType);
  EXPECT_EQ(chosen({260, 261, 262}), kX509NoneType) << "what asks for least";
  EXPECT_EQ(chosen({260, 261, 262}, SecurityLevel::kNone, true), kX509PlainType) << "a user was given";
  EXPECT_EQ(chosen({258, 259, 261}, SecurityLevel::kNone, true), kX509VncType) << "the level counts first";
}

TEST(SecurityTypes, NothingBelowTheRequiredLevelAndNeverAPasswordInTheClear) {
  EXPECT_EQ(chosen({1}, SecurityLevel::kVnc), 0u);
  EXPECT_EQ(chosen({1, 2}, SecurityLevel::kTls), 0u);
  EXPECT_EQ(chosen({257, 258, 259, 2}, SecurityLevel::kX509, true), 0u);
  EXPECT_EQ(chosen({256}, SecurityLevel::kNone, true), 0u);
  EXPECT_EQ(chosen({}), 0u);
  const std::vector<std::uint32_t> offered{1, 19, 256, 262, 30};
  EXPECT_EQ(describeSecurityTypes(offered), "None, VeNCrypt, Plain, X509Plain, 30");
}

// OpenSSL's DES gave the answer.
TEST(VncAuth, AnswersAsEveryOtherViewer) {
  std::array<std::uint8_t, 16> challenge{};
  for (std::size_t i = 0; i < 16; ++i) challenge.at(i) = static_cast<std::uint8_t>(i * 17);
  EXPECT_THAT(answerVncChallenge(challenge, "sesame"),
              ElementsAreArray(std::vector<std::uint8_t>{0xd9, 0x0a, 0xb5, 0xc7, 0x5e, 0x35, 0xc5, 0x02, 0x04, 0xf6,
                                                         0x65, 0x3a, 0x2e, 0x0b, 0xb0, 0x1b}));
  EXPECT_EQ(answerVncChallenge(challenge, "longpass"), answerVncChallenge(challenge, "longpassword"))
      << "eight characters";
  EXPECT_NE(answerVncChallenge(challenge, ""), answerVncChallenge(challenge, "a"));
}

// As x11vnc -storepasswd writes "sesame".
TEST(VncAuth, ReadsWhatVncpasswdWrote) {
  const std::array<std::uint8_t, 8> hidden{0x0b, 0xa7, 0x55, 0xa9, 0x23, 0x04, 0xb7, 0x8a};
  EXPECT_EQ(revealVncPassword(hidden).text(), "sesame");
}

std::string someFingerprint(char digit) {
  std::string text;
  for (int i = 0; i < 32; ++i) text += std::string(i == 0 ? "" : ":") + digit + digit;
  return text;
}

TEST(Fingerprint, IsReadInEveryUsualForm) {
  const std::string normal = someFingerprint('A');
  EXPECT_EQ(normalFingerprint(normal), normal);
  EXPECT_EQ(normalFingerprint("SHA256:" + normal), normal);
  EXPECT_EQ(normalFingerprint(std::string(64, 'a')), normal);
  for (const std::string& wrong :
       {std::string(), std::string(63, 'a'), std::string(65, 'a'), std::string(64, 'g'), normal + " "})
    EXPECT_FALSE(normalFingerprint(wrong).has_value()) << wrong;
}

TEST(KnownServers, KeepsEverybodyAndReplacesOnlyWhoChanged) {
  const TemporaryFolder folder;
  const KnownServers known(folder / "deep/er/known");
  EXPECT_FALSE(known.find("wall:1").has_value());
  known.remember("wall:1", someFingerprint('1'));
  known.remember("wall:11", someFingerprint('2'));
  known.remember("unix:/a b", someFingerprint('3'));
  known.remember("wall:1", someFingerprint('4'));
  EXPECT_EQ(known.find("wall:1"), someFingerprint('4'));
  EXPECT_EQ(known.find("wall:11"), someFingerprint('2'));
  EXPECT_EQ(known.find("unix:/a b"), someFingerprint('3'));
  EXPECT_FALSE(known.find("wall").has_value());
}

TEST(KnownServers, RefusesAFileThatOthersCanWriteOrThatIsBroken) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "known";
  std::ofstream(file) << "# a comment\nwall:1 SHA256:12\n";
  const auto messageOf = [&] {
    try {
      (void)KnownServers(file).find("wall:1");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(messageOf(), HasSubstr("the line of wall:1 holds no fingerprint"));
  std::filesystem::permissions(file, std::filesystem::perms::others_write, std::filesystem::perm_options::add);
  EXPECT_THAT(messageOf(), HasSubstr("chmod 600 " + file.string()));
}

TEST(KnownServers, LosesNothingWhenManyWriteAtOnce) {
  const TemporaryFolder folder;
  const KnownServers known(folder / "known");
  {
    std::vector<std::jthread> writers;
    for (int i = 0; i < 8; ++i) {
      writers.emplace_back([&known, i] {
        for (int k = 0; k < 5; ++k) known.remember(std::to_string(i) + ":" + std::to_string(k), someFingerprint('7'));
      });
    }
  }
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(known.find(std::to_string(i) + ":" + std::to_string(k)).has_value());
  }
}

Message version() {
  return Message().text("RFB 003.008\n");
}

// How the session ends with a server that says `bytes` step by step, and the last bytes it got.
Closed closedBy(const FakeVncServer::Script& script, SessionOptions options = {}) {
  const FakeVncServer server(script);
  options.server = parseServerAddress(server.address());
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  return mirror.last<Closed>().value_or(Closed{});
}

SessionOptions withEverything() {
  SessionOptions options;
  options.user = "operator";
  options.password = "secret";
  return options;
}

TEST(Security, NeverSendsAPasswordInTheClear) {
  std::vector<std::uint8_t> more;
  const Closed closed = closedBy(
      [&more](FakeConnection& client) {
        client.send(version().u8(1).u8(19));
        client.receive(13);
        client.send(Message().u8(0).u8(2));
        client.receive(2);
        client.send(Message().u8(0).u8(1).u32(256));
        more = client.receive(1);
      },
      withEverything());
  EXPECT_EQ(closed.kind, CloseKind::kUntrusted);
  EXPECT_THAT(closed.message, HasSubstr("offers Plain and no security type known here"));
  EXPECT_TRUE(more.empty());
}

TEST(Security, DoesNotGoOnInTheClearWhenEncryptionFails) {
  std::vector<std::uint8_t> more;
  const Closed closed = closedBy(
      [&more](FakeConnection& client) {
        client.send(version().u8(2).u8(2).u8(19));
        client.receive(13);
        client.send(Message().u8(0).u8(2));
        client.receive(2);
        client.send(Message().u8(0).u8(2).u32(258).u32(2));
        EXPECT_THAT(client.receive(4), ElementsAre(0, 0, 1, 2));
        client.send(Message().u8(0));
        more = client.receive(1);
      },
      withEverything());
  EXPECT_EQ(closed.kind, CloseKind::kUntrusted);
  EXPECT_THAT(closed.message, HasSubstr("offers TLSVnc but does not begin with it"));
  EXPECT_TRUE(more.empty());
}

TEST(Security, RefusesNonsenseInsteadOfTls) {
  const Closed closed = closedBy(
      [](FakeConnection& client) {
        client.send(version().u8(1).u8(19).u8(0).u8(2).u8(0).u8(1).u32(257).u8(1).text("this is no TLS at all"));
        client.drain(std::chrono::seconds(20));
      },
      withEverything());
  EXPECT_EQ(closed.kind, CloseKind::kUntrusted);
  EXPECT_THAT(closed.message, HasSubstr("no encrypted connection"));
}

TEST(Security, TakesNoControlCharactersFromTheServerIntoMessages) {
  const Closed closed =
      closedBy([](FakeConnection& client) { client.send(version().u8(0).u32(12).text("a\x1b[2Jb\nc\x07\x7f d")); });
  EXPECT_THAT(closed.message, HasSubstr("(it says: a [2Jb c   d)"));
}

TEST(Security, CutsAReasonWithoutEnd) {
  const Closed closed =
      closedBy([](FakeConnection& client) { client.send(version().u8(0).u32(0xffffffff).repeat('x', 100'000)); });
  EXPECT_EQ(closed.kind, CloseKind::kAuthentication);
  EXPECT_LT(closed.message.size(), 1500u);
}

TEST(Security, SpeaksTheOldVersionsOfTheProtocol) {
  for (const auto& [theirs, ours] : {std::pair("RFB 003.003\n", "RFB 003.003\n"),
                                     {"RFB 003.007\n", "RFB 003.007\n"},
                                     {"RFB 003.005\n", "RFB 003.003\n"},
                                     {"RFB 003.889\n", "RFB 003.008\n"},
                                     {"RFB 005.000\n", "RFB 003.008\n"}}) {
    SCOPED_TRACE(theirs);
    std::string answered;
    {
      const FakeVncServer server([&, hello = std::string(theirs), old = ours[10] == '3'](FakeConnection& client) {
        client.send(Message().text(hello));
        const std::vector<std::uint8_t> answer = client.receive(12);
        answered.assign(answer.begin(), answer.end());
        client.send(old ? Message().u32(1) : Message().u8(1).u8(1));
        if (!old) client.receive(1);
        const std::vector<std::uint8_t> greeting = FakeConnection::greeting({20, 10}, "old").bytes();
        Message init;
        for (std::size_t i = answered[10] == '8' ? 14 : 18; i < greeting.size(); ++i) init.u8(greeting[i]);
        client.send(init);
        client.drain(std::chrono::seconds(20));
      });
      DesktopMirror mirror(server.address());
      EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Connected>().has_value(); })) << mirror.summary();
      EXPECT_EQ(mirror.last<Connected>().value_or(Connected{}).size, (devices::Size{20, 10}));
    }
    EXPECT_EQ(answered, ours);
  }
}

}  // namespace
}  // namespace pixelflex::viewer
