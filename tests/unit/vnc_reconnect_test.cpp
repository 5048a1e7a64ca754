#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/backoff.h"
#include "viewer/vnc/liveness.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int32_t kRaw = 0;
constexpr std::int32_t kTight = 7;

Message filled(devices::Size desktop, std::uint8_t grey) {
  return Message().update(1).rect(0, 0, desktop.width, desktop.height, kTight).u8(0x80).repeat(grey, 3);
}

// Plays another script to each client.
FakeVncServer serverOf(std::vector<FakeVncServer::Script> scripts) {
  const int clients = static_cast<int>(scripts.size());
  return FakeVncServer([scripts = std::move(scripts),
                        next = std::size_t{0}](FakeConnection& client) mutable { scripts.at(next++)(client); },
                       FakeVncServer::Transport::kUnix, clients);
}

FakeVncServer::Script shows(devices::Size desktop, std::uint8_t grey) {
  return [desktop, grey](FakeConnection& client) {
    client.shakeHands(desktop);
    client.send(filled(desktop, grey));
    client.receive(10);  // the request for the next update tells that this one arrived
  };
}

FakeVncServer::Script showsForLong(devices::Size desktop, std::uint8_t grey) {
  return [desktop, grey](FakeConnection& client) {
    shows(desktop, grey)(client);
    client.drain(std::chrono::seconds(20));
  };
}

SessionOptions optionsFor(const FakeVncServer& server, Retry retry) {
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.retry = retry;
  return options;
}

template <class Kind>
std::size_t countOf(const DesktopMirror& mirror) {
  return static_cast<std::size_t>(std::ranges::count_if(
      mirror.events(), [](const SessionEvent& event) { return std::holds_alternative<Kind>(event); }));
}

TEST(Reconnect, FollowsARestartedServerWithAnotherDesktop) {
  const FakeVncServer server =
      serverOf({shows({40, 30}, 7), [](FakeConnection&) {}, [](FakeConnection&) {}, showsForLong({50, 20}, 9)});
  DesktopMirror mirror(optionsFor(server, Retry::kLost));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 2; })) << mirror.summary();
  EXPECT_EQ(mirror.desktop().size(), (devices::Size{50, 20}));
  EXPECT_EQ(mirror.desktop().at(49, 19, 0), 9);
  EXPECT_EQ(mirror.last<Connected>(), (Connected{"fake", {50, 20}}));
  EXPECT_THAT(mirror.last<Lost>()->message, HasSubstr("closed the connection"));
  EXPECT_EQ(countOf<Connected>(mirror), 2u);
  EXPECT_EQ(countOf<Lost>(mirror), 1u) << "once for a loss, not for each attempt";
  EXPECT_FALSE(mirror.last<Closed>().has_value());
}

TEST(Reconnect, AFirstConnectionThatFailsEndsTheSession) {
  const FakeVncServer server([](FakeConnection&) {});
  DesktopMirror mirror(optionsFor(server, Retry::kLost));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); }));
  EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kLost);
  EXPECT_FALSE(mirror.last<Lost>().has_value());
}

TEST(Reconnect, WaitsForAServerThatIsNotThereYetWhenAsked) {
  const FakeVncServer server = serverOf({[](FakeConnection&) {}, [](FakeConnection&) {}, showsForLong({40, 30}, 7)});
  DesktopMirror mirror(optionsFor(server, Retry::kAlways));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  EXPECT_TRUE(std::holds_alternative<Lost>(mirror.events().front())) << "once, before it was there";
  EXPECT_TRUE(std::holds_alternative<Connected>(mirror.events().at(1)));
}

TEST(Reconnect, ARefusalEndsTheSession) {
  const std::string reason = "Too many security failures";
  const FakeVncServer server = serverOf(
      {shows({40, 30}, 7), [&reason](FakeConnection& client) {
         client.send(Message().text("RFB 003.008\n").u8(0).u32(static_cast<std::uint32_t>(reason.size())).text(reason));
       }});
  DesktopMirror mirror(optionsFor(server, Retry::kAlways));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kAuthentication);
  EXPECT_THAT(mirror.last<Closed>()->message, HasSubstr(reason));
}

TEST(Reconnect, LetsGoOfWhatWasHeldAndSendsNothingTypedMeanwhile) {
  std::promise<void> typed;
  Bytes received;
  {
    const FakeVncServer server = serverOf({[](FakeConnection& client) {
                                             client.shakeHands({300, 200});
                                             client.receive(8 + 6);  // the key and the button below
                                           },
                                           [&](FakeConnection& client) {
                                             typed.get_future().wait();
                                             client.shakeHands({300, 200});
                                             received = client.receive(8 + 8 + 6 + 8 + 8 + 6);
                                           }});
    DesktopMirror mirror(optionsFor(server, Retry::kLost));
    ASSERT_TRUE(mirror.pumpUntil([&] { return countOf<Connected>(mirror) == 1; })) << mirror.summary();
    mirror.session().sendKey(0xffe3, true);
    mirror.session().sendPointer(100, 50, 1);
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Lost>().has_value(); })) << mirror.summary();
    mirror.session().sendKey('v', true);
    mirror.session().sendKey('v', false);
    mirror.session().sendKey('w', true);
    mirror.session().sendClipboard("void");
    typed.set_value();
    ASSERT_TRUE(mirror.pumpUntil([&] { return countOf<Connected>(mirror) == 2; })) << mirror.summary();
    mirror.session().sendKey(0xffe3, true);  // repeats
    mirror.session().sendKey('w', true);     // repeats
    mirror.session().sendKey('w', false);
    mirror.session().sendKey('w', true);
    mirror.session().sendPointer(101, 50, 1);  // still held since before
    mirror.pumpUntil([&] { return countOf<Lost>(mirror) == 2; });
  }
  EXPECT_THAT(received, ElementsAre(4, 1, 0, 0, 0, 0, 0xff, 0xe3,  // is this connection's
                                    4, 0, 0, 0, 0, 0, 0xff, 0xe3,  // and goes up
                                    5, 0, 0, 100, 0, 50,           // and the button, where the pointer was
                                    4, 0, 0, 0, 0, 0, 0, 'w',      //
                                    4, 1, 0, 0, 0, 0, 0, 'w',      // pressed anew
                                    5, 0, 0, 101, 0, 50));         // no drag begins on the new connection
}

TEST(Reconnect, ASilentServerIsAskedForASignOfLifeAndThenGivenUp) {
  Bytes asked;
  const devices::Size desktop{40, 30};
  const FakeVncServer server([&](FakeConnection& client) {
    client.shakeHands(desktop);
    client.send(filled(desktop, 7));
    client.receive(10);
    asked = client.receive(10);
    client.send(Message().update(1).rect(0, 0, 1, 1, kTight).u8(0x80).repeat(7, 3));
    client.drain(std::chrono::seconds(20));
  });
  SessionOptions options = optionsFor(server, Retry::kLost);
  options.patience = milliseconds(2000);
  DesktopMirror mirror(options);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Lost>().has_value(); })) << mirror.summary();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, options.patience) << "an answer begins a new silence";
  EXPECT_THAT(asked, ElementsAre(3, 0, 0, 0, 0, 0, 0, 1, 0, 1));
  EXPECT_EQ(mirror.updates(), 1u) << "a sign of life is no damage";
  EXPECT_THAT(mirror.last<Lost>()->message, HasSubstr("does not answer any more"));
}

TEST(Reconnect, ASignOfLifeWithANewColourIsDamage) {
  const devices::Size desktop{40, 30};
  const FakeVncServer server([&](FakeConnection& client) {
    client.shakeHands(desktop);
    client.send(filled(desktop, 7));
    client.send(Message().update(1).rect(0, 0, 1, 1, kTight).u8(0x80).repeat(8, 3));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(optionsFor(server, Retry::kNever));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 2; })) << mirror.summary();
  EXPECT_EQ(mirror.desktop().at(0, 0, 1), 8);
}

TEST(Reconnect, NoticesAServerThatStopsHalfWay) {
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({64, 64});
    client.send(Message().update(1).rect(0, 0, 64, 64, kRaw).repeat(1, 1000));
    client.drain(std::chrono::seconds(20));
  });
  SessionOptions options = optionsFor(server, Retry::kNever);
  options.patience = milliseconds(1200);
  DesktopMirror mirror(options);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kLost);
  EXPECT_THAT(mirror.last<Closed>()->message, HasSubstr("stopped answering in the middle of an update"));
}

TEST(Reconnect, AServerThatTakesNoInputIsStillListenedTo) {
  constexpr int kKeys = 20'000;
  std::promise<void> typed;
  std::promise<void> heard;
  Bytes received;
  {
    const FakeVncServer server([&](FakeConnection& client) {
      client.shakeHands({64, 64});
      typed.get_future().wait();
      client.send(Message().u8(2));
      heard.get_future().wait();
      received = client.receive(std::size_t{8} * kKeys);
    });
    DesktopMirror mirror(optionsFor(server, Retry::kNever));
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Connected>().has_value(); })) << mirror.summary();
    // Some of it is under way before the rest is there.
    for (int i = 0; i < kKeys; ++i) mirror.session().sendKey(static_cast<std::uint32_t>(i / 2), i % 2 == 0);
    typed.set_value();
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
    heard.set_value();
    mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); });
  }
  ASSERT_EQ(received.size(), std::size_t{8} * kKeys);
  for (int i = 0; i < kKeys; ++i) {
    const std::size_t at = std::size_t{8} * static_cast<std::size_t>(i);
    ASSERT_EQ(received[at + 1], i % 2 == 0);
    ASSERT_EQ(received[at + 6] << 8 | received[at + 7], i / 2);
  }
}

TEST(Backoff, IsQuickAndNeverSlow) {
  Backoff backoff;
  milliseconds total{0};
  for (int i = 0; i < 1000; ++i) {
    const milliseconds wait = backoff.after(CloseKind::kUnreachable, {});
    EXPECT_LE(wait, milliseconds(500));
    total += wait;
  }
  EXPECT_GE(total, std::chrono::seconds(490)) << "a server that is away for long is not hammered";
  EXPECT_EQ(backoff.after(CloseKind::kLost, std::chrono::seconds(5)), milliseconds(100)) << "a new loss";
  EXPECT_GE(backoff.after(CloseKind::kProtocol, {}), milliseconds(500)) << "nonsense rarely gets better at once";
}

TEST(Backoff, KnowsWhatDoesNotHeal) {
  EXPECT_TRUE(mayHeal(CloseKind::kUnreachable));
  EXPECT_TRUE(mayHeal(CloseKind::kLost));
  EXPECT_FALSE(mayHeal(CloseKind::kAuthentication));
  EXPECT_FALSE(mayHeal(CloseKind::kTooLarge));
}

TEST(Liveness, AsksOnceAndGivesUp) {
  const Deadline begin{};
  const auto at = [begin](int ms) { return begin + milliseconds(ms); };
  Liveness liveness(milliseconds(9000), begin);
  EXPECT_EQ(liveness.due(), at(4000));
  EXPECT_EQ(liveness.judge(at(3999)), Liveness::Verdict::kWait);
  EXPECT_EQ(liveness.judge(at(4000)), Liveness::Verdict::kAsk);
  EXPECT_EQ(liveness.judge(at(8999)), Liveness::Verdict::kWait);
  liveness.heard(at(8999));
  EXPECT_EQ(liveness.judge(at(12999)), Liveness::Verdict::kAsk);
  EXPECT_EQ(liveness.judge(at(17999)), Liveness::Verdict::kGone);
}

TEST(Liveness, ASleeperGivesTheServerTimeToAnswer) {
  const Deadline begin{};
  Liveness liveness(milliseconds(9000), begin);
  EXPECT_EQ(liveness.judge(begin + milliseconds(60'000)), Liveness::Verdict::kAsk);
  EXPECT_EQ(liveness.due(), begin + milliseconds(65'000));
}

}  // namespace
}  // namespace pixelflex::viewer
