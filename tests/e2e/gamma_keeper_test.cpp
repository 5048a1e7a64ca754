// Look-up tables of outputs, on an X server that has them.
#include "devices/display/gamma_keeper.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "devices/display/display_error.h"
#include "tests/support/dummy_xorg.h"

namespace pixelflex::devices {
namespace {

constexpr Size kScreen{640, 480};

class GammaKeeperTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::uint16_t> tables() const { return testing::outputTables(server_.display()); }
  /// Waits for what another process does.
  [[nodiscard]] bool becomes(const std::vector<std::uint16_t>& wanted) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (tables() != wanted) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  testing::XServer server_{testing::dummyXorg(kScreen)};
};

GammaRamp rampOf(std::size_t entries) {
  GammaRamp ramp;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < entries; ++i) ramp[c].push_back(static_cast<std::uint16_t>(i * (200 - 40 * c)));
  }
  return ramp;
}

std::vector<std::uint16_t> inARow(const GammaRamp& ramp) {
  std::vector<std::uint16_t> all;
  for (const auto& channel : ramp) all.insert(all.end(), channel.begin(), channel.end());
  return all;
}

TEST_F(GammaKeeperTest, SetsATableAndGivesTheOldOneBack) {
  const auto before = tables();
  ASSERT_FALSE(before.empty());
  {
    GammaKeeper keeper(server_.display());
    const auto entries = keeper.entriesAt({0, 0}, kScreen);
    ASSERT_EQ(3 * entries, before.size());
    EXPECT_EQ(tables(), before);
    keeper.set({0, 0}, kScreen, rampOf(entries));
    EXPECT_EQ(tables(), inARow(rampOf(entries)));
    // A second table, and the one that was there before all comes back.
    GammaRamp steeper = rampOf(entries);
    steeper[1][7] += 1000;
    keeper.set({0, 0}, kScreen, steeper);
    EXPECT_EQ(tables(), inARow(steeper));
  }
  EXPECT_EQ(tables(), before);
}

TEST_F(GammaKeeperTest, OnlyAnOutputThatShowsJustTheRectangleTakesATable) {
  const auto before = tables();
  GammaKeeper keeper(server_.display());
  EXPECT_EQ(keeper.entriesAt({0, 0}, {kScreen.width / 2, kScreen.height}), 0U);
  EXPECT_EQ(keeper.entriesAt({10, 0}, kScreen), 0U);
  EXPECT_THROW(keeper.set({10, 0}, kScreen, rampOf(before.size() / 3)), DisplayError);
  EXPECT_THROW(keeper.set({0, 0}, kScreen, rampOf(7)), DisplayError);
  EXPECT_EQ(tables(), before);
  GammaKeeper nowhere(":64999");
  EXPECT_EQ(nowhere.entriesAt({0, 0}, kScreen), 0U);
}

TEST_F(GammaKeeperTest, GivesBackWhatAKilledProcessHadSet) {
  const auto before = tables();
  const auto other = rampOf(before.size() / 3);
  const pid_t child = ::fork();
  if (child == 0) {
    GammaKeeper keeper(server_.display());
    keeper.set({0, 0}, kScreen, other);
    ::pause();
    ::_exit(0);
  }
  EXPECT_TRUE(becomes(inARow(other)));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(becomes(before));
}

}  // namespace
}  // namespace pixelflex::devices
