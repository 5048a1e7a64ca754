// The console of a wall, against simulated devices behind real TCP ports.
#include "viewer/control/wall_console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "tests/e2e/device_room.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using ::testing::Contains;
using ::testing::HasSubstr;
using viewer::ConsoleJob;
using viewer::DeviceState;
using viewer::WallConsole;
using viewer::WallSnapshot;
using Clock = std::chrono::steady_clock;

class WallConsoleTest : public DeviceRoomTest {
 protected:
  /// Within a generous time.
  [[nodiscard]] static bool comes(const WallConsole& console, const std::function<bool(const WallSnapshot&)>& wanted) {
    const auto deadline = Clock::now() + std::chrono::seconds(60);
    while (!wanted(*console.snapshot())) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  [[nodiscard]] static bool ends(const WallConsole& console, int job) {
    return comes(console, [&](const WallSnapshot& wall) { return !wall.find(job)->running; });
  }
  [[nodiscard]] static bool allAreWell(const WallSnapshot& wall) {
    for (const auto& device : wall.devices) {
      if (device->contact != DeviceState::Contact::kWell) return false;
    }
    return true;
  }
  [[nodiscard]] static std::string valueOf(const WallSnapshot& wall, const std::string& device,
                                           const std::string& setting) {
    const auto* state = wall.find(device)->find(setting);
    return state == nullptr ? "" : state->value;
  }
  [[nodiscard]] static bool logHas(const WallSnapshot& wall, const std::string& text) {
    for (const auto& line : wall.log) {
      if (line->text.find(text) != std::string::npos) return true;
    }
    return false;
  }
  /// A program in the stead of pixelflex-calibrate.
  [[nodiscard]] viewer::WallConsoleOptions withCalibrate(const std::string& script) const {
    const auto program = folder_.path() / "pixelflex-calibrate";
    std::ofstream(program) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return {.pollEvery = kPollEvery, .programs = folder_.path()};
  }
  static constexpr std::chrono::milliseconds kPollEvery{20};
  static inline const viewer::WallConsoleOptions kQuick{.pollEvery = kPollEvery};
};

TEST_F(WallConsoleTest, KnowsEveryDeviceWithItsSettings) {
  makeRoom(2);
  const WallConsole console(folder(), kQuick);
  ASSERT_TRUE(comes(console, allAreWell));
  const auto wall = console.snapshot();
  ASSERT_EQ(wall->devices.size(), 4U);
  EXPECT_EQ(valueOf(*wall, "p2.control", "brightness"), "64");
  EXPECT_EQ(wall->find("p2.control")->find("brightness")->info.maximum, 127);
  EXPECT_EQ(valueOf(*wall, "p1.mirror", "pan"), "0");
  EXPECT_THAT(wall->find("p1.mirror")->actions, Contains("home"));
  EXPECT_THAT(wall->find("p1.mirror")->identity, HasSubstr("Pan-Tilt"));
  EXPECT_EQ(wall->calibration, nullptr);
}

TEST_F(WallConsoleTest, SetsMovesAndLogsTheCommandLine) {
  makeRoom(2, 20);
  WallConsole console(folder(), kQuick);
  const int job = console.device("all", {"brightness=80", "pan_counts=200", "tilt+=0"});
  ASSERT_TRUE(ends(console, job));
  EXPECT_EQ(console.snapshot()->find(job)->error, "");
  EXPECT_EQ(projector("p2.control").brightness, 80);
  EXPECT_EQ(pan("p2.mirror").position, 200);
  EXPECT_TRUE(comes(console, [](const auto& wall) {
    return valueOf(wall, "p1.mirror", "pan_counts") == "200" && valueOf(wall, "p1.control", "brightness") == "80";
  }));
  EXPECT_TRUE(
      logHas(*console.snapshot(), "pixelflex device " + folder() + " all brightness=80 pan_counts=200 tilt+=0"));
  EXPECT_THROW((void)console.device("p9", {"mute=on"}), std::invalid_argument);
}

TEST_F(WallConsoleTest, SeesWhatOthersChange) {
  makeRoom(1);
  const WallConsole console(folder(), kQuick);
  ASSERT_TRUE(comes(console, allAreWell));
  host_.with("p1.control", [](devices::SimulatedDevice& device, auto) {
    dynamic_cast<devices::ProjectorSimulator&>(device).state().contrast = 33;
  });
  EXPECT_TRUE(comes(console, [](const auto& wall) { return valueOf(wall, "p1.control", "contrast") == "33"; }));
}

TEST_F(WallConsoleTest, StopAllHaltsEveryMirrorAndDropsWhatWaits) {
  makeRoom(2, 0.02);
  WallConsole console(folder(), kQuick);
  const int move = console.device("all", {"pan=150"});
  const int later = console.device("p1.mirror", {"tilt=20"});
  ASSERT_TRUE(comesTo(true, "p1.mirror"));
  ASSERT_TRUE(comesTo(true, "p2.mirror"));
  const int stop = console.stopAll();
  ASSERT_TRUE(ends(console, stop));
  EXPECT_EQ(console.snapshot()->find(stop)->error, "");
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_TRUE(comesTo(false, "p2.mirror"));
  ASSERT_TRUE(ends(console, move));
  ASSERT_TRUE(ends(console, later));
  EXPECT_THAT(console.snapshot()->find(later)->error, HasSubstr("stopped on request"));
  EXPECT_LT(pan("p1.mirror").position, 2900);
  EXPECT_TRUE(comes(console, [](const auto& wall) { return wall.find("p1.mirror")->trouble.empty(); }));
}

TEST_F(WallConsoleTest, OneThatIsGoneWhileItMovesLeavesNoMirrorMoving) {
  makeRoom(1, 0.02);
  {
    WallConsole console(folder(), kQuick);
    (void)console.device("p1", {"pan=150"});
    ASSERT_TRUE(comesTo(true, "p1.mirror"));
  }
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_LT(pan("p1.mirror").position, 2900);
}

TEST_F(WallConsoleTest, ADeadLineIsOneDeviceInWordsAndComesBack) {
  makeRoom(2, 20);
  WallConsole console(folder(), kQuick);
  ASSERT_TRUE(comes(console, allAreWell));
  host_.order("p1.mirror", Fault::kCut);
  ASSERT_TRUE(
      comes(console, [](const auto& wall) { return wall.find("p1.mirror")->contact == DeviceState::Contact::kLost; }));
  EXPECT_THAT(console.snapshot()->find("p1.mirror")->trouble, HasSubstr("p1.mirror at tcp://127.0.0.1:"));
  // Its values stay, and nobody else is held up.
  EXPECT_EQ(valueOf(*console.snapshot(), "p1.mirror", "pan"), "0");
  const int job = console.device("p2", {"pan_counts=100", "mute=on"});
  ASSERT_TRUE(ends(console, job));
  EXPECT_EQ(console.snapshot()->find(job)->error, "");
  EXPECT_TRUE(projector("p2.control").mute);
  host_.heal("p1.mirror");
  ASSERT_TRUE(comes(console, allAreWell));
  EXPECT_TRUE(logHas(*console.snapshot(), "p1.mirror answers again"));
  EXPECT_EQ(console.snapshot()->find("p1.mirror")->trouble, "");
}

TEST_F(WallConsoleTest, ForALostDeviceOnlySoManyCommandsWait) {
  makeRoom(2, 20);
  WallConsole console(folder(), kQuick);
  ASSERT_TRUE(comes(console, allAreWell));
  host_.order("p1.mirror", Fault::kSilent);
  const auto giveTooMany = [&] {
    for (int i = 0; i < 200; ++i) (void)console.device("p1.mirror", {i % 2 == 0 ? "pan=1" : "pan=2"});
  };
  EXPECT_THAT(giveTooMany,
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("p1.mirror: 100 commands wait for it already")));
  const int both = console.device("p1.mirror,p2.mirror", {"pan_counts=100"});
  ASSERT_TRUE(ends(console, console.device("p2.mirror", {"tilt_counts=0"})));
  EXPECT_EQ(pan("p2.mirror").position, 100) << "nobody else is held up";
  ASSERT_TRUE(ends(console, both));
  EXPECT_THAT(console.snapshot()->find(both)->error, HasSubstr("p1.mirror: 100 commands wait"));
  ASSERT_TRUE(ends(console, console.stopAll()));
  EXPECT_NO_THROW((void)console.device("p1.mirror", {"pan=1"}));
}

TEST_F(WallConsoleTest, WhatADeviceRefusesIsSaidUntilSomethingGoesWell) {
  makeRoom(1, 20);
  WallConsole console(folder(), kQuick);
  const int job = console.device("p1.mirror", {"pan=170"});
  ASSERT_TRUE(ends(console, job));
  EXPECT_THAT(console.snapshot()->find(job)->error, HasSubstr("pan=170: it can be a number from"));
  EXPECT_THAT(console.snapshot()->find("p1.mirror")->trouble, HasSubstr("pan=170"));
  ASSERT_TRUE(ends(console, console.device("p1.mirror", {"pan=10"})));
  EXPECT_EQ(console.snapshot()->find("p1.mirror")->trouble, "");
  ASSERT_TRUE(ends(console, console.device("p1.mirror", {"pan=170"})));
  EXPECT_NE(console.snapshot()->find("p1.mirror")->trouble, "");
  ASSERT_TRUE(ends(console, console.stopAll()));
  EXPECT_EQ(console.snapshot()->find("p1.mirror")->trouble, "");
  ASSERT_TRUE(ends(console, console.savePreset("here")));
  ASSERT_TRUE(ends(console, console.device("p1.mirror", {"pan=170"})));
  ASSERT_TRUE(ends(console, console.restorePreset("here", false)));
  EXPECT_EQ(console.snapshot()->find("p1.mirror")->trouble, "");
}

TEST_F(WallConsoleTest, SavesPlansRestoresAndDeletesPresets) {
  makeRoom(2, 20);
  WallConsole console(folder(), kQuick);
  ASSERT_TRUE(ends(console, console.savePreset("a")));
  ASSERT_TRUE(
      comes(console, [](const auto& wall) { return wall.presets.size() == 1 && wall.presets[0].devices == 4; }));
  ASSERT_TRUE(ends(console, console.device("all", {"pan_counts=300", "contrast=20"})));
  const int plan = console.planPreset("a");
  ASSERT_TRUE(ends(console, plan));
  EXPECT_THAT(console.snapshot()->find(plan)->said, Contains("move  p2.mirror  pan_counts=0"));
  EXPECT_EQ(pan("p2.mirror").position, 300);
  const int restore = console.restorePreset("a", false);
  ASSERT_TRUE(ends(console, restore));
  EXPECT_EQ(console.snapshot()->find(restore)->error, "");
  EXPECT_EQ(pan("p1.mirror").position, 0);
  EXPECT_EQ(projector("p2.control").contrast, 64);
  EXPECT_FALSE(projector("p2.control").mute);
  ASSERT_TRUE(ends(console, console.deletePreset("a")));
  EXPECT_TRUE(comes(console, [](const auto& wall) { return wall.presets.empty(); }));
  EXPECT_THROW((void)console.savePreset("../a"), calib::StoreError);
}

TEST_F(WallConsoleTest, CalibratesWithProgressAndOneLongJobAtATime) {
  makeRoom(1);
  WallConsole console(folder(), withCalibrate("echo \"progress projectors 12 48 p1 white\"\n"
                                              "while [ ! -e " +
                                              folder_.path().string() +
                                              "/go ]; do sleep 0.01; done\n"
                                              "echo \"report: $1/report.html\"\necho \"warning: dim\" >&2\n"));
  const int job = console.calibrate({"projectors", "--all"});
  ASSERT_TRUE(comes(console, [&](const auto& wall) { return wall.find(job)->part.has_value(); }));
  EXPECT_EQ(console.snapshot()->find(job)->part, 0.25);
  EXPECT_EQ(console.snapshot()->find(job)->state, "projectors 12 of 48, p1 white");
  EXPECT_THROW((void)console.savePreset("a"), std::runtime_error);
  std::ofstream((folder_.path() / "go").string()) << "go";
  ASSERT_TRUE(ends(console, job));
  const auto wall = console.snapshot();
  EXPECT_EQ(wall->find(job)->error, "");
  EXPECT_THAT(wall->find(job)->said, Contains("report: " + folder() + "/report.html"));
  EXPECT_TRUE(logHas(*wall, "pixelflex calibrate " + folder() + " projectors --all"));
  EXPECT_TRUE(logHas(*wall, "warning: dim"));
}

TEST_F(WallConsoleTest, ACalibrationThatFailsSaysWhyAndOneThatIsCancelledEnds) {
  makeRoom(1);
  {
    WallConsole console(folder(), withCalibrate("echo \"pixelflex-calibrate: no camera\" >&2\nexit 1\n"));
    const int job = console.calibrate({});
    ASSERT_TRUE(ends(console, job));
    EXPECT_EQ(console.snapshot()->find(job)->error, "pixelflex-calibrate: no camera");
  }
  WallConsole console(folder(), withCalibrate("echo begun\nsleep 1000\n"));
  const int job = console.calibrate({});
  ASSERT_TRUE(comes(console, [&](const auto& wall) { return !wall.find(job)->said.empty(); }));
  console.cancel(job);
  ASSERT_TRUE(ends(console, job));
  EXPECT_THAT(console.snapshot()->find(job)->error, HasSubstr("stopped on request"));
}

TEST_F(WallConsoleTest, FollowsTheWallsFiles) {
  makeRoom(1);
  const WallConsole console(folder(), kQuick);
  ASSERT_TRUE(comes(console, allAreWell));
  saveCalibration(folder(), calib::flatCalibration(calib::loadWall(folder())));
  EXPECT_TRUE(comes(console, [](const auto& wall) { return wall.calibration != nullptr; }));
  std::ofstream(folder() + "/calibration.yaml") << "format: something-else\n";
  EXPECT_TRUE(comes(console, [](const auto& wall) { return !wall.calibration && !wall.calibrationTrouble.empty(); }));
}

}  // namespace
}  // namespace pixelflex::testing
