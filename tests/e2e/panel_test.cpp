// The control panel as a person uses it: with the mouse and the keyboard.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/e2e/panel_window.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(PanelTest, ControlsSetWhatIsChosen) {
  makeRoom(2, 20);
  startPanel({"--projectors", "p1"});
  waitForSettings();
  press("set-mute-on");
  EXPECT_TRUE(comes([&] { return projector("p1.control").mute; })) << log();
  press("more-brightness");
  EXPECT_TRUE(comes([&] { return projector("p1.control").brightness == 65; })) << log();
  press("set-contrast", 0.9);
  EXPECT_TRUE(comes([&] { return projector("p1.control").contrast > 100; })) << log();
  EXPECT_FALSE(projector("p2.control").mute);
  EXPECT_EQ(projector("p2.control").contrast, 64);
  press("choose-all");
  press("set-mute-off");
  press("less-red");
  EXPECT_TRUE(comes([&] { return projector("p1.control").gain[0] == 99 && projector("p2.control").gain[0] == 99; }));
  EXPECT_TRUE(comes([&] { return !projector("p1.control").mute; }));
  panel_->signal(SIGTERM);
  EXPECT_EQ(panel_->wait(std::chrono::seconds(60)), 0) << log();
}

TEST_F(PanelTest, MirrorsAreJoggedAndComeHome) {
  makeRoom(2, 20);
  startPanel({"--projectors", "p2"});
  waitForSettings();
  press("step-3");  // 5 degrees
  press("jog-right");
  EXPECT_TRUE(comes([&] { return pan("p2.mirror").position == 97; })) << log();  // of 185.1428 arc seconds each
  key("alt+Left");
  EXPECT_TRUE(comes([&] { return pan("p2.mirror").position == 0; })) << log();
  key("alt+Left");
  EXPECT_TRUE(comes([&] { return pan("p2.mirror").position == -97; })) << log();
  press("home");
  EXPECT_TRUE(comes([&] { return pan("p2.mirror").position == 0; })) << log();
  EXPECT_EQ(pan("p1.mirror").position, 0);
}

TEST_F(PanelTest, StopAllStopsByButtonAndByKeyAndSoDoesTheEndOfThePanel) {
  makeRoom(2, 0.05);
  startPanel({"--projectors", "p1,p2"});
  waitForSettings();
  press("step-4");
  press("jog-right");
  ASSERT_TRUE(comesTo(true, "p1.mirror")) << log();
  ASSERT_TRUE(comesTo(true, "p2.mirror")) << log();
  press("stop-all");
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_TRUE(comesTo(false, "p2.mirror"));
  EXPECT_LT(pan("p1.mirror").position, 290);
  press("jog-left");
  ASSERT_TRUE(comesTo(true, "p2.mirror")) << log();
  key("F12");
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_TRUE(comesTo(false, "p2.mirror"));
  press("jog-right");
  ASSERT_TRUE(comesTo(true, "p1.mirror")) << log();
  panel_->signal(SIGKILL);
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_TRUE(comesTo(false, "p2.mirror"));
}

TEST_F(PanelTest, PresetsAreSavedAndRestored) {
  makeRoom(1, 20);
  startPanel({"--tab", "presets", "--projectors", "p1"});
  waitForSettings();
  press("preset-name");
  ASSERT_NO_THROW((void)find("preset-name-active"));
  (void)screen_.query({"xdotool", "type", "--delay", "20", "evening"});
  press("preset-save");
  ASSERT_TRUE(comes([&] { return std::filesystem::exists(folder() + "/presets/evening.yaml"); }))
      << ::testing::PrintToString(calib::presetNames(folder())) << log();
  press("set-mute-on");
  press("jog-up");
  ASSERT_TRUE(comes([&] { return projector("p1.control").mute; })) << log();
  press("preset-restore-evening");
  EXPECT_TRUE(comes([&] { return !projector("p1.control").mute; })) << log();
  ASSERT_TRUE(comes([&] { return !has("cancel"); })) << log();
  press("preset-delete-evening");
  press("delete-yes");
  EXPECT_TRUE(comes([&] { return calib::presetNames(folder()).empty(); })) << log();
}

TEST_F(PanelTest, TestPicturesAppearOnTheOutputAndGo) {
  makeRoom(1);
  calib::Wall wall = calib::loadWall(folder());
  wall.projectors[0].resolution = {300, 200};
  wall.projectors[0].output = {.kind = calib::OutputKind::kDisplay, .display = screen_.display(), .at = {1500, 100}};
  calib::saveWall(folder(), wall);
  startPanel({"--projectors", "p1"});
  waitForSettings();
  const auto showsAt = [&](int x, int y) {
    const devices::Image8 picture = grabRoot(screen_.display());
    return std::vector<int>{picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
  };
  press("picture-green");
  EXPECT_TRUE(comes([&] { return showsAt(1600, 200) == std::vector{0, 255, 0}; })) << log();
  press("picture-name");
  EXPECT_TRUE(comes([&] { return showsAt(1502, 102) == std::vector{255, 255, 255}; })) << log();
  EXPECT_TRUE(comes([&] { return showsAt(1520, 120) == std::vector{20, 60, 120}; })) << log();
  press("picture-off");
  EXPECT_TRUE(comes([&] { return showsAt(1600, 200) == std::vector{0, 0, 0}; })) << log();
  press("picture-green");
  EXPECT_TRUE(comes([&] { return showsAt(1600, 200) == std::vector{0, 255, 0}; })) << log();
  panel_->signal(SIGKILL);
  EXPECT_TRUE(comes([&] { return showsAt(1600, 200) == std::vector{0, 0, 0}; })) << "none outlives the panel";
}

/// Three metres away, a picture of a pixel for each millimetre.
void saveCalibrationOf(const std::string& folder) {
  calib::Calibration calibration = calib::flatCalibration(calib::loadWall(folder));
  for (auto& projector : calibration.projectors) {
    for (auto& number : projector.model.projectorFromWall) number /= 3000;
    projector.model.projectorFromWall[8] = 1;
    projector.model.scale = 3000;
  }
  calib::saveCalibration(folder, calibration);
}

TEST_F(PanelTest, AFootprintThatIsDraggedTurnsItsMirror) {
  makeRoom(2, 20);
  saveCalibrationOf(folder());
  startPanel();
  const Box first = find("footprint-p1");
  const Box second = find("footprint-p2");
  const double pixelsPerMillimetre = (second.x - first.x) / 1024;
  // Where the mirror is, is known.
  press("projector-p1");
  waitForSettings();
  move(first.x + 2, first.y + 2);
  (void)screen_.query({"xdotool", "mousedown", "1"});
  move(first.x + 42, first.y + 2);
  move(first.x + 82, first.y + 2);
  (void)screen_.query({"xdotool", "mouseup", "1"});
  // The beam turns twice as far as the mirror.
  const double radiansPerCount = 185.1428 / 3600 * std::numbers::pi / 180;
  const double counts = 80 / pixelsPerMillimetre / (2 * 3000 * radiansPerCount);
  EXPECT_TRUE(comes([&] { return std::abs(pan("p1.mirror").position - counts) < 2; }))
      << "to be " << counts << ", is " << pan("p1.mirror").position << "\n"
      << log();
  EXPECT_EQ(pan("p2.mirror").position, 0);
}

TEST_F(PanelTest, CalibratesAtAButton) {
  makeRoom(1);
  startPanel({"--tab", "calibration"});
  press("opens-report");  // no browser here
  press("calibrate-stale");
  EXPECT_TRUE(comes([&] { return std::filesystem::exists(folder() + "/report.html"); })) << log();
  press("tab-map");
  EXPECT_NO_THROW((void)find("footprint-p1"));
}

TEST_F(PanelTest, WhatOpensTheReportHearsItsOwnSignals) {
  makeRoom(1);
  std::ofstream(folder() + "/report.html") << "a report";
  const auto opener = folder_ / "xdg-open";
  const std::string blocked = (folder_ / "blocked").string();
  // Other shells unblock what they find blocked.
  std::ofstream(opener) << "#!/bin/bash\ngrep SigBlk /proc/self/status > " << blocked << "\n";
  std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
  startPanel({"--tab", "calibration", "--projectors", "p1"},
             {"PATH=" + opener.parent_path().string() + ":" + std::getenv("PATH")});
  waitForSettings();
  press("open-report");
  EXPECT_TRUE(comes([&] { return textOf(blocked) == "SigBlk:\t0000000000000000\n"; })) << textOf(blocked) << log();
}

TEST_F(PanelTest, ShowsWhatTheCameraSees) {
  ASSERT_EQ(runProgram("new", {folder(), "--rig", kMiniRig}).status, 0);
  startPanel({"--tab", "camera"});
  EXPECT_NO_THROW((void)find("camera-picture"));
}

TEST_F(PanelTest, DeadLinesDoNotHoldItUpAndTheScreenshotIsWritten) {
  makeRoom(2);
  host_.order("p1.mirror", devices::Fault::kCut);
  const std::string file = (folder_ / "panel.png").string();
  startPanel({"--screenshot", file, "--size", "1280x720"});
  EXPECT_EQ(panel_->wait(std::chrono::seconds(90)), 0) << log();
  EXPECT_EQ(devices::readPng8(file).size(), (devices::Size{1280, 720}));
}

TEST_F(PanelTest, SaysWhatIsWrong) {
  makeRoom(1);
  const Output size = runProgram("panel", {folder(), "--size", "big"});
  EXPECT_EQ(size.status, 2);
  EXPECT_THAT(size.text, HasSubstr("\"big\" is no size; write WIDTHxHEIGHT"));
  const Output wall = runProgram("panel", {(folder_ / "none").string()});
  EXPECT_EQ(wall.status, 1);
  EXPECT_THAT(wall.text, HasSubstr("pixelflex-panel: "));
  const Output show = runProgram("panel", {folder(), "--show", "grid", "--projectors", "p1"});
  EXPECT_EQ(show.status, 1);
  EXPECT_THAT(show.text, HasSubstr("p1: wall.yaml gives it no monitor or display"));
}

}  // namespace
}  // namespace pixelflex::testing
