#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using std::chrono::milliseconds;
using ::testing::ElementsAre;

constexpr std::int32_t kRaw = 0;
constexpr std::int32_t kCopyRect = 1;
constexpr std::int32_t kTight = 7;
constexpr std::int32_t kDesktopSize = -223;
constexpr std::int32_t kLastRect = -224;
constexpr std::int32_t kPointerPos = -232;
constexpr std::int32_t kRichCursor = -239;
constexpr std::int32_t kAlphaCursor = -314;
constexpr std::int32_t kVmwarePosition = 0x574d5666;

// One colour for a whole rectangle, in Tight.
Message fill(int x, int y, int w, int h, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return Message().rect(x, y, w, h, kTight).u8(0x80).u8(red).u8(green).u8(blue);
}

// Plays `updates` after the handshake and stays until the client leaves.
FakeVncServer::Script sends(devices::Size desktop, const Message& messages) {
  return [desktop, messages](FakeConnection& client) {
    client.shakeHands(desktop, "a wall");
    client.send(messages);
    client.drain(std::chrono::seconds(20));
  };
}

SessionOptions optionsFor(const FakeVncServer& server) {
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  return options;
}

std::vector<int> pixelOf(const DesktopMirror& mirror, int x, int y) {
  const devices::Image8& desktop = mirror.desktop();
  return {desktop.at(x, y, 0), desktop.at(x, y, 1), desktop.at(x, y, 2)};
}

TEST(Session, AnnouncesTheDesktopAndShowsItsFirstPicture) {
  Message update = Message().update(1).rect(0, 0, 3, 2, kRaw);
  for (std::uint32_t i = 0; i < 6; ++i) update.u8(10 + i).u8(20 + i).u8(30 + i).u8(0x77);
  const FakeVncServer server(sends({3, 2}, update));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  EXPECT_EQ(mirror.last<Connected>(), (Connected{"a wall", {3, 2}}));
  for (int i = 0; i < 6; ++i) EXPECT_THAT(pixelOf(mirror, i % 3, i / 3), ElementsAre(10 + i, 20 + i, 30 + i));
}

TEST(Session, SendsOnlyWhatChanged) {
  const FakeVncServer server(sends({100, 80}, Message()
                                                  .update(1)
                                                  .append(fill(0, 0, 100, 80, 1, 2, 3))
                                                  .update(2)
                                                  .append(fill(5, 6, 7, 8, 9, 9, 9))
                                                  .rect(50, 60, 7, 8, kCopyRect)
                                                  .u16(5)
                                                  .u16(6)));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 2; })) << mirror.summary();
  EXPECT_EQ(mirror.bytes(), 4u * (100 * 80 + 2 * 7 * 8));
  EXPECT_THAT(pixelOf(mirror, 56, 67), ElementsAre(9, 9, 9));
  EXPECT_THAT(pixelOf(mirror, 57, 67), ElementsAre(1, 2, 3));
}

TEST(Session, KeepsAnUpdateWholeHoweverManyBatchesItTakes) {
  const FakeVncServer server(sends(
      {4096, 3000}, Message().update(0xffff).append(fill(0, 0, 4096, 3000, 7, 8, 9)).rect(0, 0, 0, 0, kLastRect)));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  // 256 rows fit into one.
  static_assert(FrameBelt::kMaxBytes == 4096U * 4 * 256);
  EXPECT_EQ(mirror.batches(), 12U);
  EXPECT_THAT(pixelOf(mirror, 4095, 2999), ElementsAre(7, 8, 9));
}

TEST(Session, AsksForTheNextChangeAfterEachUpdate) {
  std::vector<std::uint8_t> request;
  {
    const FakeVncServer server([&request](FakeConnection& client) {
      client.shakeHands({64, 48});
      client.send(Message().update(1).append(fill(0, 0, 64, 48, 1, 1, 1)));
      request = client.receive(10);
    });
    DesktopMirror mirror(server.address());
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); }));
  }
  EXPECT_THAT(request, ElementsAre(3, 1, 0, 0, 0, 0, 0, 64, 0, 48));
}

std::vector<std::int32_t> encodingsAskedFor(bool lossless) {
  std::vector<std::uint8_t> message;
  {
    const FakeVncServer server([&message](FakeConnection& client) { message = client.shakeHands({8, 8}); });
    SessionOptions options = optionsFor(server);
    options.lossless = lossless;
    options.link = viewer::Link::kLan;
    DesktopMirror mirror(options);
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); }));
  }
  std::vector<std::int32_t> encodings;
  for (std::size_t i = 4; i + 3 < message.size(); i += 4) {
    encodings.push_back(static_cast<std::int32_t>(std::uint32_t{message[i]} << 24 |
                                                  std::uint32_t{message[i + 1]} << 16 |
                                                  std::uint32_t{message[i + 2]} << 8 | message[i + 3]));
  }
  return encodings;
}

TEST(Session, AsksForNoJpegUnlessToldTo) {
  const auto isQuality = ::testing::AllOf(::testing::Ge(-32), ::testing::Le(-23));
  const std::vector<std::int32_t> lossless = encodingsAskedFor(true);
  EXPECT_EQ(lossless.at(0), kTight);
  EXPECT_THAT(lossless, ::testing::Not(::testing::Contains(isQuality)));
  EXPECT_THAT(encodingsAskedFor(false), ::testing::Contains(isQuality));
}

TEST(Session, FollowsADesktopThatChangesItsSize) {
  const FakeVncServer server(sends({20, 10}, Message()
                                                 .update(1)
                                                 .append(fill(0, 0, 20, 10, 5, 6, 7))
                                                 .update(1)
                                                 .rect(0, 0, 30, 8, kDesktopSize)
                                                 .update(1)
                                                 .append(fill(29, 7, 1, 1, 200, 201, 202))));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 3; })) << mirror.summary();
  EXPECT_EQ(mirror.last<Resized>(), (Resized{{30, 8}}));
  EXPECT_EQ(mirror.desktop().size(), (devices::Size{30, 8}));
  EXPECT_EQ(mirror.bytes(), 4u * (20 * 10 + 30 * 8 + 1)) << "a change of size damages the whole desktop";
  EXPECT_THAT(pixelOf(mirror, 19, 7), ElementsAre(5, 6, 7)) << "what was there stays until it is replaced";
  EXPECT_THAT(pixelOf(mirror, 29, 7), ElementsAre(200, 201, 202));
}

TEST(Session, ReportsPointerShapes) {
  Message rich = Message().rect(1, 0, 2, 2, kRichCursor);
  rich.u8(1).u8(2).u8(3).u8(0).u8(4).u8(5).u8(6).u8(0).repeat(7, 8).u8(0x80).u8(0x40);
  Message alpha = Message().rect(0, 1, 1, 2, kAlphaCursor).u32(0);
  alpha.u8(100).u8(50).u8(0).u8(128).u8(9).u8(9).u8(9).u8(255);
  const FakeVncServer server(sends({8, 8}, Message()
                                               .update(3)
                                               .append(rich)
                                               .append(alpha)
                                               .rect(0, 0, 0, 0, kAlphaCursor)
                                               .u32(0)
                                               .update(1)
                                               .append(fill(0, 0, 1, 1, 1, 1, 1))));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  EXPECT_EQ(mirror.bytes(), 4u) << "a pointer's shape is no damage";
  ASSERT_EQ(mirror.events().size(), 4u);
  EXPECT_EQ(std::get<CursorShape>(mirror.events()[1]),
            (CursorShape{{2, 2}, 1, 0, {1, 2, 3, 255, 4, 5, 6, 0, 7, 7, 7, 0, 7, 7, 7, 255}}));
  EXPECT_EQ(std::get<CursorShape>(mirror.events()[2]), (CursorShape{{1, 2}, 0, 1, {199, 100, 0, 128, 9, 9, 9, 255}}));
  EXPECT_EQ(std::get<CursorShape>(mirror.events()[3]), (CursorShape{{0, 0}, 0, 0, {}}));
}

TEST(Session, TakesOverAPointerThatTheServerDraws) {
  std::vector<std::uint8_t> first;
  std::vector<std::uint8_t> second;
  {
    const Message hidden = Message().update(1).rect(0, 0, 0, 0, kAlphaCursor).u32(0);
    const FakeVncServer server([&](FakeConnection& client) {
      const std::size_t encodings = client.shakeHands({400, 300}).size();
      client.send(hidden);
      first = client.receive(10 + 6 + encodings);  // request, pointer, SetEncodings
      client.send(hidden);
      second = client.receive(10);  // only the request
    });
    DesktopMirror mirror(server.address());
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  }
  ASSERT_GT(first.size(), 16u);
  EXPECT_THAT(std::vector<std::uint8_t>(first.begin() + 10, first.begin() + 17), ElementsAre(5, 0, 0, 200, 0, 150, 2));
  EXPECT_EQ(second.size(), 10u);
}

TEST(Session, ReportsBellClipboardAndPointerPosition) {
  const FakeVncServer server(sends({8, 8}, Message()
                                               .u8(2)
                                               .u8(3)
                                               .repeat(0, 3)
                                               .u32(5)
                                               .text("h\xe9llo")
                                               .update(2)
                                               .rect(3, 4, 0, 0, kPointerPos)
                                               .rect(5, 6, 0, 0, kVmwarePosition)
                                               .u8(2)));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.events().size() == 6; })) << mirror.summary();
  EXPECT_TRUE(std::holds_alternative<Bell>(mirror.events()[1]));
  EXPECT_EQ(std::get<Clipboard>(mirror.events()[2]), Clipboard{"héllo"});
  EXPECT_EQ(std::get<CursorMoved>(mirror.events()[3]), (CursorMoved{3, 4}));
  EXPECT_EQ(std::get<CursorMoved>(mirror.events()[4]), (CursorMoved{5, 6}));
  EXPECT_EQ(mirror.updates(), 0u);
}

// Everything the client sends after the handshake, up to `count` bytes.
std::vector<std::uint8_t> inputReceived(std::size_t count, bool viewOnly,
                                        const std::function<void(DesktopSource&)>& act) {
  std::vector<std::uint8_t> received;
  {
    const FakeVncServer server([&](FakeConnection& client) {
      client.shakeHands({300, 200});
      received = client.receive(count);
    });
    SessionOptions options = optionsFor(server);
    options.viewOnly = viewOnly;
    DesktopMirror mirror(options);
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Connected>().has_value(); })) << mirror.summary();
    act(mirror.session());
    if (viewOnly) {
      mirror.pumpFor(milliseconds(100));
    } else {
      EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
    }
  }
  return received;
}

TEST(Session, SendsInputInOrder) {
  const std::vector<std::uint8_t> received = inputReceived(6 + 8 + 6 + 8 + 2, false, [](DesktopSource& session) {
    session.sendPointer(258, 100, 1);
    session.sendKey(0xff0d, true);
    session.sendPointer(-5, 1000, 0);
    session.sendClipboard("é→");
  });
  EXPECT_THAT(received, ElementsAre(5, 1, 1, 2, 0, 100,                   // pointer
                                    4, 1, 0, 0, 0, 0, 0xff, 0x0d,         // key
                                    5, 0, 0, 0, 0, 199,                   // pointer, clamped
                                    6, 0, 0, 0, 0, 0, 0, 2, 0xe9, '?'));  // clipboard, Latin-1
}

TEST(Session, SendsNothingWhenOnlyViewing) {
  EXPECT_TRUE(inputReceived(1, true, [](DesktopSource& session) {
                session.sendPointer(1, 1, 1);
                session.sendKey('a', true);
                session.sendClipboard("text");
              }).empty());
}

TEST(Session, SleepsWhileNothingChanges) {
  const FakeVncServer server(sends({64, 64}, Message().update(1).append(fill(0, 0, 64, 64, 1, 1, 1))));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  // On a busy machine what the update began may last into the first seconds.
  double used = 1;
  for (int second = 0; second < 20 && used >= 0.02; ++second) {
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    used = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  }
  EXPECT_LT(used, 0.02) << "seconds of processor time in one idle second";
}

// The server may stay silent for twenty seconds; whoever waits for it takes as long.
constexpr milliseconds kNotHanging{5000};

// How long it takes to get rid of a session.
milliseconds timeToStop(std::unique_ptr<DesktopMirror> mirror) {
  const auto begin = std::chrono::steady_clock::now();
  mirror.reset();
  return std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begin);
}

TEST(Session, StopsAtOnceWhileTheServerIsSilent) {
  const FakeVncServer server([](FakeConnection& client) { client.drain(std::chrono::seconds(20)); });
  auto mirror = std::make_unique<DesktopMirror>(server.address());
  mirror->pumpFor(milliseconds(50));
  EXPECT_LT(timeToStop(std::move(mirror)), kNotHanging);
}

TEST(Session, StopsAtOnceInTheMiddleOfTheHandshake) {
  const FakeVncServer server([](FakeConnection& client) {
    client.send(Message().text("RFB 003.008\n").u8(1));
    client.drain(std::chrono::seconds(20));
  });
  auto mirror = std::make_unique<DesktopMirror>(server.address());
  mirror->pumpFor(milliseconds(50));
  EXPECT_LT(timeToStop(std::move(mirror)), kNotHanging);
}

TEST(Session, StopsAtOnceInTheMiddleOfAnUpdate) {
  const FakeVncServer server(sends({64, 64}, Message().update(1).rect(0, 0, 64, 64, kRaw).repeat(1, 1000)));
  auto mirror = std::make_unique<DesktopMirror>(server.address());
  ASSERT_TRUE(mirror->pumpUntil([&] { return mirror->last<Connected>().has_value(); }));
  mirror->pumpFor(milliseconds(50));
  EXPECT_LT(timeToStop(std::move(mirror)), kNotHanging);
}

TEST(Session, StopsAtOnceWhileNobodyTakesItsBatches) {
  Message updates;
  for (int i = 0; i < 20; ++i) updates.update(1).append(fill(0, 0, 64, 64, 1, 1, 1));
  const FakeVncServer server(sends({64, 64}, updates));
  std::atomic<int> published = 0;
  FrameBelt belt([&published] { ++published; });
  auto session = std::make_unique<Session>(optionsFor(server), belt, nullptr);
  while (published < static_cast<int>(FrameBelt::kSlots)) std::this_thread::yield();
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(published, static_cast<int>(FrameBelt::kSlots)) << "the session must wait for a free batch";
  const auto begin = std::chrono::steady_clock::now();
  session.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kNotHanging);
}

TEST(Session, SaysNothingMoreOnceStopped) {
  const FakeVncServer server(sends({8, 8}, Message().u8(2)));
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); }));
  mirror.session().stop();
  mirror.session().sendKey('a', true);
  mirror.pumpFor(milliseconds(100));
  EXPECT_FALSE(mirror.last<Closed>().has_value());
}

}  // namespace
}  // namespace pixelflex::viewer
