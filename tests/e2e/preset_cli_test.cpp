#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "calib/store/preset.h"
#include "devices/image/png_file.h"
#include "tests/e2e/device_room.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using devices::Fault;
using ::testing::HasSubstr;
using ::testing::Not;

class PresetCliTest : public DeviceRoomTest {
 protected:
  [[nodiscard]] Output preset(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), folder());
    return runProgram("preset", arguments);
  }
  /// A calibration of which the mask of p1 is all of one grey.
  void calibrate(int grey) const {
    calib::Calibration calibration = flatCalibration(calib::loadWall(folder()));
    calibration.projectors[0].alpha = "calibration/p1-alpha.png";
    devices::Image16 mask({1024, 768}, 1);
    for (int y = 0; y < 768; ++y) {
      for (int x = 0; x < 1024; ++x) mask.at(x, y) = static_cast<std::uint16_t>(grey);
    }
    fs::create_directories(folder() + "/calibration");
    devices::writePng(folder() + "/calibration/p1-alpha.png", mask);
    saveCalibration(folder(), calibration);
  }
  [[nodiscard]] int greyInUse() const {
    const auto calibration = calib::loadCalibration(folder());
    return devices::readPng16(fs::path(folder()) / *calibration.projectors[0].alpha).at(0, 0);
  }
  [[nodiscard]] std::size_t keptCalibrations() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder() + "/presets")) count += entry.is_directory() ? 1 : 0;
    return count;
  }
};

TEST_F(PresetCliTest, SavingAgainForgetsNoDeviceThatIsDead) {
  makeRoom(1, 20);
  ASSERT_EQ(device({"p1", "pan_counts=300", "brightness=70"}).status, 0);
  ASSERT_EQ(preset({"save", "day"}).status, 0);
  const calib::Preset before = calib::loadPreset(folder(), "day");
  host_.order("p1.control", Fault::kCut);
  ASSERT_EQ(device({"p1.mirror", "pan_counts=200"}).status, 0);
  const Output again = preset({"save", "day"});
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.text, HasSubstr("day has of these devices what it had before"));
  const calib::Preset after = calib::loadPreset(folder(), "day");
  ASSERT_EQ(after.devices.size(), 2U);
  EXPECT_THAT(after.devices, ::testing::Contains(before.devices[0]));
  EXPECT_THAT(after.devices, Not(::testing::Contains(before.devices[1])));
  host_.order("p1.mirror", Fault::kCut);
  const Output dead = preset({"save", "day"});
  EXPECT_EQ(dead.status, 1);
  EXPECT_THAT(dead.text, HasSubstr("no device could be read, so day was not saved"));
  EXPECT_EQ(calib::loadPreset(folder(), "day"), after);
  EXPECT_THAT(preset({"restore", "day", "--dry-run"}).text, HasSubstr("of these devices nothing is known"));
}

TEST_F(PresetCliTest, ComesBackToWhatWasSaved) {
  makeRoom(2, 20);
  calibrate(1000);
  ASSERT_EQ(device({"p1", "pan_counts=300", "brightness=70", "input=rgb2"}).status, 0);
  const Output saved = preset({"save", "day"});
  EXPECT_EQ(saved.text, "day: 4 devices and the calibration\n");
  calibrate(2000);
  ASSERT_EQ(device({"all", "pan_counts=-500", "brightness=20", "mute=on", "input=video1"}).status, 0);
  ASSERT_EQ(preset({"save", "night"}).status, 0);
  const Output dry = preset({"restore", "day", "--dry-run"});
  EXPECT_THAT(dry.text, HasSubstr("move         p1.mirror pan_counts=300\n"));
  EXPECT_THAT(dry.text, HasSubstr("colour       p1.control brightness=70\n"));
  EXPECT_THAT(dry.text, HasSubstr("calibration  the preset's\n"));
  EXPECT_EQ(pan("p1.mirror").position, -500);
  const Output day = preset({"restore", "day"});
  EXPECT_EQ(day.status, 0) << day.text;
  EXPECT_EQ(pan("p1.mirror").position, 300);
  EXPECT_EQ(pan("p2.mirror").position, 0);
  EXPECT_EQ(projector("p1.control").brightness, 70);
  EXPECT_EQ(projector("p1.control").input, 0x22);
  EXPECT_FALSE(projector("p1.control").mute);
  EXPECT_EQ(greyInUse(), 1000);
  EXPECT_EQ(preset({"restore", "night"}).status, 0);
  EXPECT_EQ(pan("p2.mirror").position, -500);
  EXPECT_TRUE(projector("p2.control").mute);
  EXPECT_EQ(greyInUse(), 2000);
  EXPECT_EQ(runProgram("check", {folder()}).status, 0);
}

TEST_F(PresetCliTest, WhatIsInPlaceTakesNoTime) {
  makeRoom(4, 20);
  calibrate(1000);
  ASSERT_EQ(preset({"save", "a"}).status, 0);
  calibrate(2000);
  ASSERT_EQ(preset({"save", "b"}).status, 0);
  for (const auto* name : {"a", "b", "a"}) {
    const Output output = preset({"restore", name});
    EXPECT_THAT(output.text, HasSubstr(": 0 settings changed, calibration restored in 0."));
  }
  EXPECT_EQ(greyInUse(), 1000);
  EXPECT_EQ(preset({"restore", "a", "--dry-run"}).text, "all is as a has it\n");
  EXPECT_TRUE(preset({"restore", "a"}).text.starts_with("a: 0 settings changed, calibration as it was in 0."));
}

TEST_F(PresetCliTest, CalibrationsAreKeptOnceAndGoWithTheirPresets) {
  makeRoom(1, 20);
  calibrate(1000);
  ASSERT_EQ(preset({"save", "a"}).status, 0);
  ASSERT_EQ(preset({"save", "b"}).status, 0);
  EXPECT_EQ(keptCalibrations(), 1U);
  ASSERT_EQ(preset({"restore", "a"}).status, 0);
  ASSERT_EQ(preset({"save", "c"}).status, 0);  // of what is in use already
  EXPECT_EQ(keptCalibrations(), 1U);
  EXPECT_THAT(preset({"list"}).text, HasSubstr("a  2"));
  EXPECT_THAT(preset({"list"}).text, HasSubstr("2 devices, calibration in use\n"));
  for (const auto* name : {"a", "b", "c"}) EXPECT_EQ(preset({"delete", name}).status, 0);
  EXPECT_EQ(keptCalibrations(), 1U);  // the wall uses it
  EXPECT_EQ(greyInUse(), 1000);
  calibrate(5);
  ASSERT_EQ(preset({"save", "d"}).status, 0);
  EXPECT_EQ(keptCalibrations(), 1U);  // the old one went
}

TEST_F(PresetCliTest, ADeadDeviceIsOneErrorAndTheRestIsRestored) {
  makeRoom(3, 20);
  ASSERT_EQ(device({"all", "pan_counts=200"}).status, 0);
  EXPECT_EQ(preset({"save", "a"}).text, "a: 6 devices, no calibration\n");
  ASSERT_EQ(device({"all", "home"}).status, 0);
  host_.order("p2.mirror", Fault::kCut);
  const Output output = preset({"restore", "a"});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("pixelflex-preset: p2.mirror at tcp://127.0.0.1:"));
  EXPECT_EQ(pan("p1.mirror").position, 200);
  EXPECT_EQ(pan("p3.mirror").position, 200);
  EXPECT_FALSE(projector("p1.control").mute);
  host_.heal("p2.mirror");
  EXPECT_EQ(preset({"restore", "a"}).status, 0);
  EXPECT_EQ(pan("p2.mirror").position, 200);
}

TEST_F(PresetCliTest, WhatIsOffIsLitFirst) {
  makeRoom(1, 20);
  ASSERT_EQ(device({"p1", "brightness=33"}).status, 0);
  ASSERT_EQ(preset({"save", "a"}).status, 0);
  ASSERT_EQ(device({"p1", "brightness=99", "power=off"}).status, 0);
  const Output output = preset({"restore", "a"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_TRUE(projector("p1.control").isOn());
  EXPECT_EQ(projector("p1.control").brightness, 33);
}

TEST_F(PresetCliTest, ASignalHaltsAndUnmutes) {
  makeRoom(1, 0.02);
  const std::string file = folder() + "/presets/far.yaml";
  writeText(file,
            "format: pixelflex-preset\nversion: 1\nsaved: now\ndevices:\n"
            "  - {name: p1.control, driver: proxima-dp6850, settings: {power: \"on\", mute: \"off\"}}\n"
            "  - {name: p1.mirror, driver: ptu, settings: {pan_counts: 3000}}\n");
  Process process({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-preset", folder(), "restore", "far"});
  ASSERT_TRUE(comesTo(true, "p1.mirror"));
  EXPECT_TRUE(projector("p1.control").mute);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(std::chrono::seconds(60)), 1);
  EXPECT_FALSE(moves("p1.mirror"));
  EXPECT_LT(pan("p1.mirror").position, 2900);
  EXPECT_FALSE(projector("p1.control").mute);
}

TEST_F(PresetCliTest, WithoutACameraNothingIsVerified) {
  makeRoom(1, 20);
  calibrate(1000);
  ASSERT_EQ(preset({"save", "a"}).status, 0);
  calibrate(2000);
  const Output output = preset({"restore", "a", "--verify"});
  EXPECT_EQ(output.status, 0);
  EXPECT_THAT(output.text, HasSubstr("has no camera of its own: nothing was verified"));
  EXPECT_EQ(greyInUse(), 1000);
}

TEST_F(PresetCliTest, SaysWhatIsWrong) {
  makeRoom(1, 20);
  EXPECT_THAT(preset({"restore", "x"}).text, HasSubstr("there is no preset of that name; none was saved yet"));
  ASSERT_EQ(preset({"save", "a"}).status, 0);
  EXPECT_THAT(preset({"delete", "x"}).text, HasSubstr("there is no preset of that name; there are a"));
  EXPECT_THAT(preset({"save", "../x"}).text, HasSubstr("a preset's name is made of letters"));
  EXPECT_EQ(preset({"save"}).status, 2);
  EXPECT_EQ(preset({"forget", "a"}).status, 2);
  const std::string file = folder() + "/presets/a.yaml";
  writeText(file, replaced(textOf(file), "driver: ptu", "driver: other"));
  EXPECT_THAT(preset({"restore", "a"}).text, HasSubstr("p1.mirror: the preset is of another driver, other"));
}

}  // namespace
}  // namespace pixelflex::testing
