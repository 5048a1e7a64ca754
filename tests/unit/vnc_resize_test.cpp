// Desktops that change their size, and servers that know less about that than others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int32_t kTight = 7;
constexpr std::int32_t kDesktopSize = -223;
constexpr std::int32_t kExtendedDesktopSize = -308;

Message filled(devices::Size size, std::uint8_t grey) {
  return Message().update(1).rect(0, 0, size.width, size.height, kTight).u8(0x80).repeat(grey, 3);
}

Message resized(devices::Size size) {
  return Message().update(1).rect(0, 0, size.width, size.height, kDesktopSize);
}

SessionOptions resizing(const FakeVncServer& server) {
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.mayResize = true;
  return options;
}

std::vector<Bytes> sentAfter(FakeConnection& client, const Message& message, const std::vector<std::size_t>& counts) {
  client.send(message);
  std::vector<Bytes> sent;
  for (const std::size_t count : counts) sent.push_back(client.receive(count));
  return sent;
}

TEST(DesktopSize, AloneIsFollowedAndTheNewDesktopAskedForWhole) {
  std::vector<Bytes> sent;
  {
    const FakeVncServer server([&sent](FakeConnection& client) {
      client.shakeHands({40, 30});
      client.send(filled({40, 30}, 1));
      client.receive(10);
      sent = sentAfter(client, resized({70, 20}), {10, 10});
      client.send(filled({70, 20}, 2));
      client.receive(10);
      client.send(resized({10, 50}));
      client.receive(20);
      client.send(filled({10, 50}, 3));
      client.drain(std::chrono::seconds(20));
    });
    DesktopMirror mirror(resizing(server));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 5; })) << mirror.summary();
    EXPECT_EQ(mirror.last<Resized>(), (Resized{{10, 50}}));
    EXPECT_EQ(mirror.desktop().size(), (devices::Size{10, 50}));
    EXPECT_EQ(mirror.desktop().at(9, 49, 0), 3);
  }
  EXPECT_THAT(sent, ElementsAre(ElementsAre(3, 1, 0, 0, 0, 0, 0, 40, 0, 30),  // what changes, before it was known
                                ElementsAre(3, 0, 0, 0, 0, 0, 0, 70, 0, 20)));
}

TEST(DesktopSize, AloneMeansThatNoOtherSizeCanBeAskedFor) {
  Bytes next;
  {
    const FakeVncServer server([&next](FakeConnection& client) {
      client.shakeHands({40, 30});
      client.send(filled({40, 30}, 1));
      client.receive(10);
      client.send(filled({40, 30}, 2));
      next = client.receive(10);
      client.drain(std::chrono::seconds(20));
    });
    DesktopMirror mirror(resizing(server));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Connected>().has_value(); })) << mirror.summary();
    EXPECT_TRUE(mirror.session().requestLayout({{80, 60}, {{0, 0, 80, 60}}}));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<ResizeRefused>() && mirror.updates() == 2; }))
        << mirror.summary();
    EXPECT_THAT(mirror.last<ResizeRefused>()->message, HasSubstr("cannot change its desktop's size"));
    EXPECT_EQ(mirror.desktop().size(), (devices::Size{40, 30}));
  }
  EXPECT_THAT(next, ElementsAre(3, 1, 0, 0, 0, 0, 0, 40, 0, 30)) << "no message that it does not know";
}

// Servers that know neither encoding have nothing left but to end the connection.
TEST(DesktopSize, NeitherKnownIsFollowedByANewConnection) {
  int connection = 0;
  const FakeVncServer server(
      [&connection](FakeConnection& client) {
        const devices::Size size = connection++ == 0 ? devices::Size{40, 30} : devices::Size{70, 20};
        client.shakeHands(size);
        client.send(filled(size, static_cast<std::uint8_t>(connection)));
        client.receive(10);
        if (connection == 2) client.drain(std::chrono::seconds(20));
      },
      FakeVncServer::Transport::kUnix, 2);
  SessionOptions options = resizing(server);
  options.retry = Retry::kLost;
  DesktopMirror mirror(options);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 2; })) << mirror.summary();
  EXPECT_EQ(mirror.desktop().size(), (devices::Size{70, 20}));
  EXPECT_EQ(mirror.desktop().at(69, 19, 0), 2);
}

// TigerVNC's own fallback, which libvncclient by itself would not follow.
TEST(DesktopSize, ExtendedWithAScreenNumberedZeroIsFollowed) {
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({40, 30});
    client.send(filled({40, 30}, 1));
    Message extended = Message().update(1).rect(0, 0, 70, 20, kExtendedDesktopSize);
    client.send(extended.u8(1).repeat(0, 3).u32(0).u16(0).u16(0).u16(70).u16(20).u32(0));
    client.send(filled({70, 20}, 2));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(resizing(server));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 3; })) << mirror.summary();
  EXPECT_EQ(mirror.desktop().size(), (devices::Size{70, 20}));
  EXPECT_EQ(mirror.desktop().at(69, 19, 0), 2);
}

}  // namespace
}  // namespace pixelflex::viewer
