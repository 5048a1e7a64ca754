// A network that is cut without a word between a viewer and a real server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "tests/support/cut_relay.h"
#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::CutRelay;
using pixelflex::testing::DesktopMirror;
using pixelflex::testing::keysDown;
using pixelflex::testing::XvncServer;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::uint32_t kControlLeft = 0xffe3;

class CutNetwork : public ::testing::Test {
 protected:
  static int portOf(const std::string& address) { return std::stoi(address.substr(address.rfind(':') + 1)); }
  SessionOptions options() const {
    SessionOptions options{.server = parseServerAddress(network_.address())};
    options.retry = Retry::kLost;
    return options;
  }
  [[nodiscard]] static std::ptrdiff_t connections(const DesktopMirror& mirror) {
    return std::ranges::count_if(mirror.events(), [](const auto& e) { return std::holds_alternative<Connected>(e); });
  }
  [[nodiscard]] const std::string& display() { return server_.x().display(); }
  void paint(const std::string& colour) { server_.x().query({"xsetroot", "-solid", colour}); }

  /// Cuts it and waits until that is noticed.
  Seconds cut(DesktopMirror& mirror) {
    const auto losses = [&] {
      return std::ranges::count_if(mirror.events(), [](const auto& e) { return std::holds_alternative<Lost>(e); });
    };
    const auto before = losses();
    const auto begin = Clock::now();
    network_.cut();
    EXPECT_TRUE(mirror.pumpUntil([&] { return losses() > before; }, 60s)) << mirror.summary();
    return Clock::now() - begin;
  }
  /// Heals it and waits for the desktop of now.
  Seconds heal(DesktopMirror& mirror) {
    const auto begin = Clock::now();
    const auto updates = mirror.updates();
    network_.heal();
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > updates; }, 60s)) << mirror.summary();
    const Seconds back = Clock::now() - begin;
    EXPECT_TRUE(mirror.pumpUntilEqual(display())) << mirror.summary();
    return back;
  }

  XvncServer server_{{.size = {320, 240}, .unixSocket = false, .tcp = true}};
  CutRelay network_{portOf(server_.tcpAddress())};
};

TEST_F(CutNetwork, IsNoticedThePictureStaysAndWhatWasHeldIsLetGo) {
  paint("#206040");
  DesktopMirror mirror(options());
  ASSERT_TRUE(mirror.pumpUntilEqual(display())) << mirror.summary();
  mirror.session().sendKey(kControlLeft, true);
  ASSERT_TRUE(mirror.pumpUntil([&] { return keysDown(display()) == 1; }));
  const devices::Image8 last = mirror.desktop();

  const Seconds noticed = cut(mirror);
  EXPECT_LT(noticed, 15s);  // ten on a machine that has nothing else to do
  paint("#604020");
  mirror.session().sendKey('x', true);
  mirror.session().sendKey('x', false);
  mirror.pumpFor(1700ms);  // some attempts in vain
  EXPECT_TRUE(mirror.desktop() == last) << "the last picture stays";
  EXPECT_EQ(keysDown(display()), 1U) << "the server knows nothing yet";

  const Seconds back = heal(mirror);
  EXPECT_LT(back, 10s);  // one on a machine that has nothing else to do
  EXPECT_TRUE(mirror.pumpUntil([&] { return keysDown(display()) == 0; })) << "the key goes up on the server";
  EXPECT_GE(connections(mirror), 2);
  std::cout << "noticed after " << noticed.count() << " s, back after " << back.count() << " s\n";
}

TEST_F(CutNetwork, IsCrossedAsSoonAsItHealsWheneverThatIs) {
  SessionOptions impatient = options();
  impatient.patience = 1200ms;
  DesktopMirror mirror(impatient);
  ASSERT_TRUE(mirror.pumpUntilEqual(display())) << mirror.summary();
  Seconds longest{0};
  for (const auto away : {50ms, 700ms, 1150ms, 1600ms, 2300ms, 3100ms}) {
    cut(mirror);
    mirror.pumpFor(away);
    longest = std::max(longest, heal(mirror));
  }
  std::cout << "at most " << longest.count() << " s after the network\n";
  EXPECT_LT(longest, 10s);  // one on a machine that has nothing else to do
}

TEST_F(CutNetwork, IsNoticedInTheMiddleOfUpdatesAndInputToo) {
  server_.x().start({"bash", "-c", "for i in {1..100000}; do xsetroot -mod $((RANDOM % 14 + 2)) 16 -fg red; done"});
  DesktopMirror mirror(options());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > 3; })) << mirror.summary();
  mirror.session().sendPointer(10, 10, 1);
  const auto begin = Clock::now();
  network_.cut();
  const auto lost = [&] {
    mirror.session().sendPointer(static_cast<int>(mirror.batches() % 300), 20, 1);
    return mirror.last<Lost>().has_value();
  };
  ASSERT_TRUE(mirror.pumpUntil(lost, 60s)) << mirror.summary();
  EXPECT_LT(Clock::now() - begin, 15s);
  network_.heal();
  EXPECT_TRUE(mirror.pumpUntil([&] { return connections(mirror) >= 2; }, 60s)) << mirror.summary();
}

}  // namespace
}  // namespace pixelflex::viewer
