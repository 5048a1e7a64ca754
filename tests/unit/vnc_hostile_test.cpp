#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using ::testing::HasSubstr;

// Says all of `bytes`, whatever the client answers, and hangs up; gives back how the session ended.
Closed closedAfter(const Message& bytes) {
  const FakeVncServer server([&bytes](FakeConnection& client) { client.send(bytes); });
  DesktopMirror mirror(server.address());
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  return mirror.last<Closed>().value_or(Closed{});
}

Closed closedAfterHandshakeAnd(const Message& bytes) {
  return closedAfter(FakeConnection::greeting({64, 48}).append(bytes));
}

TEST(HostileServer, MayHangUpAfterAnyByte) {
  // A session with something of everything.
  Message all = FakeConnection::greeting({16, 12}, "a recorded desktop");
  all.update(4);
  all.rect(0, 0, 4, 3, 0).repeat(0x11, 48);             // raw
  all.rect(4, 0, 4, 3, 1).u16(0).u16(0);                // copy
  all.rect(0, 4, 16, 8, 7).u8(0x80).u8(1).u8(2).u8(3);  // Tight, one colour
  all.rect(0, 0, 3, 1, 7).u8(0x00).repeat(0x22, 9);     // Tight, too few bytes to compress
  all.u8(3).repeat(0, 3).u32(6).text("copied");
  all.u8(1).u8(0).u16(0).u16(2).repeat(0, 12);
  all.update(3);
  all.rect(1, 1, 8, 2, -239).repeat(0x33, 64).repeat(0xff, 2);  // pointer shapes
  all.rect(0, 0, 2, 2, -314).u32(0).repeat(0x44, 16);
  all.rect(0, 0, 20, 15, -223);  // another size
  for (std::size_t length = 0; length < all.bytes().size(); ++length) {
    SCOPED_TRACE(::testing::Message() << "after " << length << " bytes");
    Message part;
    for (std::size_t i = 0; i < length; ++i) part.u8(all.bytes()[i]);
    const Closed closed = closedAfter(part);
    ASSERT_EQ(closed.kind, CloseKind::kLost) << closed.message;
    ASSERT_FALSE(closed.message.empty());
  }
}

TEST(HostileServer, CannotMakeTheNameGiant) {
  Message greeting;
  const std::vector<std::uint8_t> usual = FakeConnection::greeting({64, 48}, "").bytes();
  for (std::size_t i = 0; i + 4 < usual.size(); ++i) greeting.u8(usual[i]);
  const Closed closed = closedAfter(greeting.u32(0xffffffff).repeat('x', 100));
  EXPECT_EQ(closed.kind, CloseKind::kProtocol);
  EXPECT_THAT(closed.message, HasSubstr("name"));
}

TEST(HostileServer, CannotEndTheSessionWithAGiantClipboard) {
  constexpr std::uint32_t kGiant = 5u << 20;
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({8, 8});
    client.send(Message().u8(3).repeat(0, 3).u32(kGiant).repeat('x', kGiant).u8(2));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
  EXPECT_FALSE(mirror.last<Clipboard>().has_value());
  EXPECT_EQ(closedAfterHandshakeAnd(Message().u8(3).repeat(0, 3).u32(0x80000000).repeat('x', 100)).kind,
            CloseKind::kLost);
}

TEST(HostileServer, IsReadOnAfterAColourMap) {
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({8, 8});
    client.send(Message().u8(1).u8(0).u16(0).u16(256).repeat(0xab, std::size_t{6} * 256).u8(2));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
}

// Without anybody taking what arrives.
TEST(HostileServer, CannotFillTheMemoryWithEvents) {
  constexpr int kShapes = 400;
  Message update = Message().update(kShapes);
  for (int i = 0; i < kShapes; ++i) update.rect(0, 0, 64, 64, -314).u32(0).repeat(0x44, 4 * 64 * 64);
  Message rest;
  for (int i = 0; i < 60; ++i) {
    rest.u8(2).u8(3).repeat(0, 3).u32(1000).repeat('x', 1000).update(1).rect(i, i, 0, 0, -232).update(1);
    rest.rect(0, 0, 9 + i, 9, -223);
  }
  std::atomic<bool> sent = false;
  const FakeVncServer server([&](FakeConnection& client) {
    client.shakeHands({9, 9});
    client.send(update);
    client.send(rest);
    sent = true;
    client.drain(std::chrono::seconds(20));
  });
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  FrameBelt belt(nullptr);
  Session session(options, belt, nullptr);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!sent && std::chrono::steady_clock::now() < deadline) {
    if (Batch* batch = belt.take()) belt.release(batch);
    std::this_thread::yield();
  }
  EXPECT_TRUE(sent);
  const std::vector<SessionEvent> events = session.takeEvents();
  ASSERT_FALSE(events.empty());
  EXPECT_LE(events.size(), 50u);
  EXPECT_THAT(events.front(), ::testing::VariantWith<Connected>(::testing::_));
}

// Every update makes the client ask for the next one.
TEST(HostileServer, CannotHoldWhoeverItDoesNotListenTo) {
  Message updates;
  for (int i = 0; i < 100'000; ++i) updates.update(0);
  const FakeVncServer server([&updates](FakeConnection& client) {
    client.send(FakeConnection::greeting({8, 8}));
    client.send(updates);
    std::this_thread::sleep_for(std::chrono::seconds(2));
  });
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.patience = std::chrono::milliseconds(1200);
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>().value_or(Closed{}).kind, CloseKind::kLost);
  EXPECT_THAT(mirror.last<Closed>().value_or(Closed{}).message, HasSubstr("takes nothing more"));
}

// A byte now and then is not enough to be kept waiting for.
TEST(HostileServer, CannotDragTheHandshakeOut) {
  const FakeVncServer server([](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(255));
    while (true) {
      client.send(Message().u8(99));
      client.drain(std::chrono::milliseconds(20));
    }
  });
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.connectTimeout = std::chrono::milliseconds(300);
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>().value_or(Closed{}).kind, CloseKind::kUnreachable) << mirror.summary();
}

// Updates with the right heads and nonsense in them, in the encodings that are asked for.
Message nonsense(unsigned seed) {
  std::mt19937 random(seed);
  constexpr std::array<std::int32_t, 9> kEncodings{0, 1, 7, 7, 16, -223, -239, -240, -314};
  Message bytes;
  for (int i = 0; i < 6; ++i) {
    const auto pick = [&random](unsigned most) { return static_cast<int>(random() % most); };
    bytes.update(1).rect(pick(40), pick(30), pick(30), pick(20), kEncodings.at(random() % kEncodings.size()));
    for (int count = pick(200); count > 0; --count) bytes.u8(pick(3) == 0 ? 0u : static_cast<std::uint32_t>(pick(256)));
  }
  return bytes;
}

TEST(HostileServer, MaySendNonsense) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    ASSERT_FALSE(closedAfterHandshakeAnd(nonsense(seed)).message.empty());
  }
}

}  // namespace
}  // namespace pixelflex::viewer
