#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "viewer/control/device_command.h"
#include "viewer/control/preset_plan.h"

namespace pixelflex::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using viewer::DeviceStep;
using viewer::PresetStage;
using viewer::PresetStep;

const calib::Preset kPreset{
    "2026-01-01T00:00:00Z",
    {{"p1.control", "pjlink", {{"power", "on"}, {"mute", "off"}, {"brightness", "60"}, {"input", "rgb1"}}},
     {"p1.mirror", "ptu", {{"pan_counts", "100"}, {"tilt_counts", "-5"}, {"pan_speed", "900"}}}},
    std::nullopt};
const viewer::DeviceValues kSame = {
    {"p1.control", {{"power", "on"}, {"mute", "off"}, {"brightness", "60"}, {"input", "rgb1"}}},
    {"p1.mirror", {{"pan_counts", "100"}, {"tilt_counts", "-5"}, {"pan_speed", "900"}}}};

TEST(PresetPlan, NothingIsDoneToWhatIsInPlace) {
  EXPECT_THAT(viewer::planPreset(kPreset, kSame), IsEmpty());
}

TEST(PresetPlan, AMoveIsMadeInTheDark) {
  auto now = kSame;
  now["p1.mirror"]["pan_counts"] = "0";
  now["p1.control"]["brightness"] = "50";
  EXPECT_THAT(viewer::planPreset(kPreset, now),
              ElementsAre(PresetStep{PresetStage::kMute, "p1.control", {{"mute", "on"}}},
                          PresetStep{PresetStage::kMove, "p1.mirror", {{"pan_counts", "100"}}},
                          PresetStep{PresetStage::kColour, "p1.control", {{"brightness", "60"}}},
                          PresetStep{PresetStage::kUnmute, "p1.control", {{"mute", "off"}}}));
}

TEST(PresetPlan, ColourAloneNeedsNoDark) {
  auto now = kSame;
  now["p1.control"]["brightness"] = "50";
  EXPECT_THAT(viewer::planPreset(kPreset, now),
              ElementsAre(PresetStep{PresetStage::kColour, "p1.control", {{"brightness", "60"}}}));
}

TEST(PresetPlan, WhatIsOffIsSwitchedOnAndSetFromScratch) {
  auto now = kSame;
  now["p1.control"] = {{"power", "off"}};
  EXPECT_THAT(viewer::planPreset(kPreset, now),
              ElementsAre(PresetStep{PresetStage::kPower, "p1.control", {{"power", "on"}}},
                          PresetStep{PresetStage::kColour, "p1.control", {{"brightness", "60"}}},
                          PresetStep{PresetStage::kInput, "p1.control", {{"input", "rgb1"}}},
                          PresetStep{PresetStage::kUnmute, "p1.control", {{"mute", "off"}}}));
}

TEST(PresetPlan, WhatIsToBeOffIsOnlySwitchedOff) {
  calib::Preset preset = kPreset;
  preset.devices[0].settings[0].second = "off";
  EXPECT_THAT(viewer::planPreset(preset, kSame),
              ElementsAre(PresetStep{PresetStage::kPower, "p1.control", {{"power", "off"}}}));
}

TEST(PresetPlan, WhoIsNotThereIsLeftAlone) {
  auto now = kSame;
  now.erase("p1.control");
  now["p1.mirror"]["tilt_counts"] = "9";
  EXPECT_THAT(viewer::planPreset(kPreset, now),
              ElementsAre(PresetStep{PresetStage::kMove, "p1.mirror", {{"tilt_counts", "-5"}}}));
}

TEST(PresetPlan, WhatStaysMutedIsMutedOnce) {
  calib::Preset preset = kPreset;
  preset.devices[0].settings[1].second = "on";
  auto now = kSame;
  now["p1.mirror"]["pan_counts"] = "0";
  EXPECT_THAT(viewer::planPreset(preset, now),
              ElementsAre(PresetStep{PresetStage::kMute, "p1.control", {{"mute", "on"}}},
                          PresetStep{PresetStage::kMove, "p1.mirror", {{"pan_counts", "100"}}}));
}

TEST(PresetFile, WritesWhatItReads) {
  calib::Preset preset = kPreset;
  preset.calibration = "presets/calibration-0123456789abcdef";
  EXPECT_EQ(calib::parsePreset(calib::formatPreset(preset), "x.yaml"), preset);
  EXPECT_EQ(calib::parsePreset(calib::formatPreset({"now", {}, {}}), "x.yaml"), (calib::Preset{"now", {}, {}}));
}

TEST(PresetFile, NamesLeadNowhereElse) {
  for (const std::string name : {"", ".hidden", "../x", "a/b", "a b"}) {
    EXPECT_THROW(calib::checkPresetName(name), std::runtime_error) << name;
  }
  EXPECT_NO_THROW(calib::checkPresetName("wall-3x3.night"));
  EXPECT_THROW((void)calib::parsePreset("format: pixelflex-preset\nversion: 1\nsaved: x\ndevices: []\n"
                                        "calibration: presets/calibration-/../../etc\n",
                                        "x.yaml"),
               std::runtime_error);
}

TEST(DeviceCommand, ReadsSteps) {
  using Kind = DeviceStep::Kind;
  EXPECT_EQ(viewer::parseDeviceStep("pan"), (DeviceStep{Kind::kRead, "pan", "", 0}));
  EXPECT_EQ(viewer::parseDeviceStep("pan=-3.5"), (DeviceStep{Kind::kWrite, "pan", "-3.5", 0}));
  EXPECT_EQ(viewer::parseDeviceStep("zoom+=2"), (DeviceStep{Kind::kNudge, "zoom", "", 2}));
  EXPECT_EQ(viewer::parseDeviceStep("zoom-=2"), (DeviceStep{Kind::kNudge, "zoom", "", -2}));
  EXPECT_EQ(viewer::parseDeviceStep("home"), (DeviceStep{Kind::kAct, "home", "", 0}));
  EXPECT_EQ(viewer::parseDeviceStep("halt"), (DeviceStep{Kind::kHalt, "halt", "", 0}));
  for (const std::string wrong : {"", "=", "=3", "pan=", "pan+=", "pan+=x", "Pan", "pan tilt", "pan-=nan"}) {
    EXPECT_THROW((void)viewer::parseDeviceStep(wrong), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace pixelflex::testing
