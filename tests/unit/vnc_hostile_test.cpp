#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
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

struct Hostile {
  const char* name = nullptr;
  Message bytes;
  CloseKind kind = CloseKind::kProtocol;
  const char* says = nullptr;
};

TEST(HostileServer, EndsWithAMessageWhateverItSends) {
  const Hostile cases[] = {
      {"no pixels", FakeConnection::greeting({0, 0}), CloseKind::kProtocol, "a desktop of 0x0"},
      {"no columns", FakeConnection::greeting({0, 100}), CloseKind::kProtocol, "a desktop of 0x100"},
      {"65535x65535", FakeConnection::greeting({65535, 65535}), CloseKind::kTooLarge, "65535x65535"},
      {"shrinks to nothing", Message(FakeConnection::greeting({9, 9})).update(1).rect(0, 0, 0, 0, -223),
       CloseKind::kProtocol, "a desktop of 0x0"},
      {"version without numbers", Message().text("RFB abc.def\n"), CloseKind::kNotVnc, "RFB abc.def"},
  };
  for (const Hostile& hostile : cases) {
    SCOPED_TRACE(hostile.name);
    const Closed closed = closedAfter(hostile.bytes);
    EXPECT_EQ(closed.kind, hostile.kind) << closed.message;
    EXPECT_THAT(closed.message, HasSubstr(hostile.says));
  }
}

TEST(HostileServer, EndsWithAMessageWhateverItSendsLater) {
  const Hostile cases[] = {
      {"rectangle outside", Message().update(1).rect(60, 0, 10, 10, 0).repeat(0, 400), CloseKind::kProtocol,
       "Rect too large"},
      {"rectangle far outside", Message().update(1).rect(65535, 65535, 65535, 65535, 7).repeat(0, 400),
       CloseKind::kProtocol, "Rect too large"},
      {"copy from outside", Message().update(1).rect(0, 0, 10, 10, 1).u16(60).u16(40), CloseKind::kProtocol,
       "out of bounds"},
      {"unknown encoding", Message().update(1).rect(0, 0, 1, 1, 12345), CloseKind::kProtocol, "encoding 12345"},
      {"unknown message", Message().u8(77), CloseKind::kProtocol, "unknown type 77"},
      {"message of another dialect", Message().u8(11).repeat(0, 3).u32(0xffffffff), CloseKind::kProtocol, "type 11"},
      {"huge pointer", Message().update(1).rect(0, 0, 64, 48, -314).u32(7), CloseKind::kProtocol, "pointer shape"},
      {"bad Tight filter", Message().update(1).rect(0, 0, 8, 8, 7).u8(0x40).u8(9), CloseKind::kProtocol, "filter"},
      {"bad Tight stream", Message().update(1).rect(0, 0, 8, 8, 7).u8(0).u8(20).repeat(0xee, 20), CloseKind::kProtocol,
       "nflate"},
      {"bad ZRLE stream", Message().update(1).rect(0, 0, 8, 8, 16).u32(20).repeat(0xee, 20), CloseKind::kProtocol,
       "not valid VNC"},
  };
  for (const Hostile& hostile : cases) {
    SCOPED_TRACE(hostile.name);
    const Closed closed = closedAfterHandshakeAnd(hostile.bytes);
    EXPECT_EQ(closed.kind, hostile.kind) << closed.message;
    EXPECT_THAT(closed.message, HasSubstr(hostile.says));
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
  EXPECT_EQ(closedAfterHandshakeAnd(Message().u8(3).repeat(0, 3).u32(0xffffffff).repeat('x', 100)).kind,
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
