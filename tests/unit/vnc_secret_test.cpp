// Passwords leave nothing behind in memory.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support/memory_search.h"
#include "tests/support/tls_server.h"
#include "viewer/vnc/secret.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::DisguisedText;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::isInMemory;
using pixelflex::testing::Message;
using pixelflex::testing::TlsServer;

Secret secretOf(const DisguisedText& text) {
  std::array<char, 64> letters{};
  text.copyTo(letters.data());
  Secret secret(std::string_view(letters.data(), text.size()));
  wipe(letters);
  return secret;
}

TEST(SecretTest, LeavesNothingBehindWhenItIsCopiedMovedOrReplaced) {
  const DisguisedText text(15);  // which a string would hold within itself
  {
    std::optional<Secret> first = secretOf(text);
    const Secret second = *first;
    const Secret third = std::move(*first);
    EXPECT_EQ(second.text(), third.text());
    EXPECT_EQ(second.size(), 15U);
    first = second;
    EXPECT_TRUE(isInMemory(text));
  }
  EXPECT_FALSE(isInMemory(text));
  Secret replaced = secretOf(text);
  replaced = "another";
  EXPECT_EQ(replaced.text(), "another");
  EXPECT_FALSE(isInMemory(text));
}

TEST(SecretTest, ASessionForgetsWhatItLoggedInWith) {
  const DisguisedText text(8);
  {
    const FakeVncServer server([](FakeConnection& client) {
      client.send(Message().text("RFB 003.008\n").u8(1).u8(2));
      client.receive(13);
      client.send(Message().repeat(7, 16));
      client.receive(16);
      client.send(Message().u32(0));
      client.receive(1);
      Message init;
      const auto greeting = FakeConnection::greeting({20, 10}).bytes();
      for (std::size_t i = 18; i < greeting.size(); ++i) init.u8(greeting[i]);
      client.send(init);
      client.drain(std::chrono::seconds(20));
    });
    SessionOptions options;
    options.server = parseServerAddress(server.address());
    options.password = secretOf(text);
    DesktopMirror mirror(std::move(options));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Connected>().has_value(); })) << mirror.summary();
    EXPECT_TRUE(isInMemory(text)) << "for the next connection";
  }
  EXPECT_FALSE(isInMemory(text));
}

TEST(SecretTest, ASessionForgetsWhatItSentThroughTls) {
  const DisguisedText text(24);
  {
    // It does not read what is sent, or it would be one more who knows.
    const FakeVncServer server([](FakeConnection& client) {
      client.send(Message().text("RFB 003.008\n").u8(1).u8(19));
      client.receive(13);
      client.send(Message().u8(0).u8(2));
      client.receive(2);
      client.send(Message().u8(0).u8(1).u32(259));
      client.receive(4);
      client.send(Message().u8(1));
      const TlsServer tls(client, nullptr);
      tls.send(Message().u32(0));
      client.receive(40);
    });
    SessionOptions options;
    options.server = parseServerAddress(server.address());
    options.user = "operator";
    options.password = secretOf(text);
    DesktopMirror mirror(std::move(options));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  }
  EXPECT_FALSE(isInMemory(text));
}

}  // namespace
}  // namespace pixelflex::viewer
