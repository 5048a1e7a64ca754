// A simulated room as its devices set it, and what is published to it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>
#include <vector>

#include "calib/simulate/live_room.h"
#include "calib/simulate/placed_optics.h"
#include "calib/simulate/projector_setting.h"
#include "calib/simulate/rig.h"
#include "calib/simulate/room_folder.h"
#include "calib/simulate/simulated_wall.h"
#include "devices/image/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using devices::Image8;
using devices::Scene;
using pixelflex::testing::TemporaryFolder;

Rig miniRig() {
  return loadRig(std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/mini-2.yaml");
}

glm::dvec3 axisOf(const SimulatedProjectorSpec& spec) {
  return roomFromDevice(spec.pose.rotation) * glm::dvec3(0, 0, 1);
}

double degreesBetween(glm::dvec3 a, glm::dvec3 b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

Image8 plain(devices::Size size, int code) {
  Image8 image(size, 1);
  std::ranges::fill(image.samples(), static_cast<std::uint8_t>(code));
  return image;
}

double meanOf(const Image8& photo) {
  double sum = 0;
  for (const auto code : photo.samples()) sum += code;
  return sum / static_cast<double>(photo.samples().size());
}

TEST(ProjectorSetting, WithoutAnyNothingChanges) {
  const auto spec = miniRig().projectors[0];
  EXPECT_EQ(asSet(spec, {}), spec);
  const Image8 frame = plain(spec.resolution, 77);
  EXPECT_EQ(asSet(frame, ProjectorSetting{}), frame);
}

TEST(ProjectorSetting, PanTurnsTheBeamOnceAndTiltTwice) {
  const auto spec = miniRig().projectors[0];
  const auto panned = asSet(spec, {.mirror = {3, 0}});
  const auto tilted = asSet(spec, {.mirror = {0, 3}});
  EXPECT_NEAR(degreesBetween(axisOf(spec), axisOf(panned)), 3, 1e-6);
  EXPECT_NEAR(degreesBetween(axisOf(spec), axisOf(tilted)), 6, 1e-6);
  EXPECT_GT(axisOf(panned).x, axisOf(spec).x);  // to the right
  EXPECT_LT(axisOf(tilted).y, axisOf(spec).y);  // up
}

TEST(ProjectorSetting, TheBeamLeavesFromTheMiddleOfTheMirror) {
  auto spec = miniRig().projectors[1];
  spec.mirrorDistance = 340;
  const glm::dvec3 mirror = spec.pose.position + 340.0 * axisOf(spec);
  const auto turned = asSet(spec, {.mirror = {-7, 4}});
  EXPECT_LT(glm::distance(turned.pose.position + 340.0 * axisOf(turned), mirror), 1e-6);
}

TEST(ProjectorSetting, ThePictureRollsWithThePan) {
  // The light comes from straight below, so panning turns the picture about the upright axis as a whole: like a
  // periscope's, it rolls by as much as it turns.
  SimulatedProjectorSpec spec = miniRig().projectors[0];
  spec.pose.rotation = {0, 0, 0};
  const auto panned = asSet(spec, {.mirror = {10, 0}});
  const glm::dvec3 right = roomFromDevice(panned.pose.rotation) * glm::dvec3(1, 0, 0);
  EXPECT_NEAR(std::abs(right.y), std::sin(glm::radians(10.0)), 1e-9);
}

TEST(ProjectorSetting, LensAndLampActOnTheOptics) {
  const auto spec = miniRig().projectors[0];
  EXPECT_NEAR(asSet(spec, {.zoom = 1}).optics.focal / asSet(spec, {.zoom = -1}).optics.focal, 1 / 1.3, 0.001);
  EXPECT_GT(asSet(spec, {.focus = 0.5}).defocus, spec.defocus + 1);
  EXPECT_DOUBLE_EQ(asSet(spec, {.shift = {0.4, 0}}).optics.principal.x, spec.optics.principal.x + 64);
  EXPECT_EQ(asSet(spec, {.lit = false}).lumens, 0);
}

TEST(ProjectorSetting, PictureSettingsActOnCodes) {
  const Image8 frame = plain({2, 2}, 100);
  const Image8 set = asSet(frame, {.brightness = 10, .contrast = 0.5, .gain = {1, 2, 10}});
  EXPECT_EQ(set.at(1, 1, 0), 60);
  EXPECT_EQ(set.at(1, 1, 1), 120);
  EXPECT_EQ(set.at(1, 1, 2), 255);
  EXPECT_TRUE(asSet(frame, {.muted = true}).empty());
}

class LiveRoomTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  Rig rig_ = miniRig();
  PublishedRoom published_{folder_.path(), rig_};
  LiveRoom room_{rig_, folder_.path()};
};

TEST_F(LiveRoomTest, WhatIsPublishedIsSeenAsIfShownInTheRoomItself) {
  published_.projectors()[1]->show(plain(rig_.projectors[1].resolution, 180));
  SimulatedWall wall(rig_);
  wall.projector(1).show(plain(rig_.projectors[1].resolution, 180));
  wall.camera().exposureControl()->setExposure(0.02);
  EXPECT_EQ(room_.photograph(0.02), wall.camera().shoot());  // even its noise
}

TEST_F(LiveRoomTest, ScenesArePublishedToo) {
  const double dark = meanOf(room_.photograph(0.05));
  ASSERT_TRUE(published_.person().arrange(Scene::kRoomLight, 0));
  EXPECT_GT(meanOf(room_.photograph(0.05)), 3 * dark);
  EXPECT_FALSE(published_.person().arrange(Scene::kCheckerboard, rig_.checkerboardPoses));
  EXPECT_TRUE(published_.person().placeCamera(0));
  EXPECT_FALSE(published_.person().placeCamera(1));
}

TEST_F(LiveRoomTest, BlackAgainWhenThePublisherBlanksOrEnds) {
  const double dark = meanOf(room_.photograph(0.02));
  {
    const PublishedRoom other(folder_.path(), rig_);
    other.projectors()[0]->show(plain(rig_.projectors[0].resolution, 255));
    EXPECT_GT(meanOf(room_.photograph(0.02)), dark + 5);
    other.projectors()[0]->blank();
    EXPECT_NEAR(meanOf(room_.photograph(0.02)), dark, 0.2);
    other.projectors()[0]->show(plain(rig_.projectors[0].resolution, 255));
  }
  EXPECT_NEAR(meanOf(room_.photograph(0.02)), dark, 0.2);
}

TEST_F(LiveRoomTest, AMovedProjectorIsSeenWhereItsMirrorThrowsIt) {
  const ProjectorSetting turned{.mirror = {1.5, -0.5}, .zoom = 0.3};
  room_.set({turned, {}});
  published_.projectors()[0]->show(plain(rig_.projectors[0].resolution, 255));
  Rig moved = rig_;
  moved.projectors[0] = asSet(moved.projectors[0], turned);
  SimulatedWall wall(moved, rig_);
  wall.projector(0).show(plain(rig_.projectors[0].resolution, 255));
  wall.camera().exposureControl()->setExposure(0.02);
  EXPECT_EQ(room_.photograph(0.02), wall.camera().shoot());
  EXPECT_EQ(loadRig(folder_ / "rig.yaml").projectors, moved.projectors);
}

TEST_F(LiveRoomTest, OthersLookTheSameWhenOneIsZoomedOrOff) {
  published_.projectors()[1]->show(plain(rig_.projectors[1].resolution, 255));
  const double before = meanOf(room_.photograph(0.02));
  room_.set({{.zoom = -1}, {}});
  EXPECT_NEAR(meanOf(room_.photograph(0.02)), before, 0.02 * before);
  room_.set({{.lit = false}, {}});
  EXPECT_NEAR(meanOf(room_.photograph(0.02)), before, 0.02 * before);
}

TEST_F(LiveRoomTest, AFrozenPictureStays) {
  published_.projectors()[0]->show(plain(rig_.projectors[0].resolution, 255));
  const double lit = meanOf(room_.photograph(0.02));
  room_.set({{.frozen = true}, {}});
  published_.projectors()[0]->blank();
  EXPECT_NEAR(meanOf(room_.photograph(0.02)), lit, 0.2);
  room_.set({{}, {}});
  EXPECT_LT(meanOf(room_.photograph(0.02)), lit - 5);
}

TEST_F(LiveRoomTest, FilesThatAreNoPicturesOfTheProjectorAreRefusedByName) {
  devices::writeFileAtomically(folder_ / "p1.png", "not a picture");
  EXPECT_THROW((void)room_.photograph(0.02), std::runtime_error);
  published_.projectors()[0]->blank();
  EXPECT_NO_THROW((void)room_.photograph(0.02));
  EXPECT_THROW(published_.projectors()[0]->show(plain({4, 4}, 255)), std::invalid_argument);
}

}  // namespace
}  // namespace pixelflex::calib
