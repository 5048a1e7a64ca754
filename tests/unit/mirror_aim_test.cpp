// How far a mirror must turn to move a footprint.
#include "viewer/panel/mirror_aim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>

#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using viewer::AimPose;
using viewer::MirrorAim;

constexpr double kDegreesPerCount = 185.1428 / 3600;

/// Looks straight at a wall two metres away.
calib::ProjectorCalibration projectorAt(glm::dvec2 centre) {
  calib::ProjectorCalibration projector;
  projector.name = "p1";
  projector.resolution = {1000, 800};
  projector.model.centre = {500, 400};
  projector.model.scale = 1500;
  projector.model.projectorFromWall = {1 / 2000.0, 0, -centre.x / 2000, 0, 1 / 2000.0, -centre.y / 2000, 0, 0, 1};
  return projector;
}

TEST(MirrorAim, TurnsTheBeamTwiceAsFarAsTheMirror) {
  const MirrorAim aim = viewer::aimByGeometry(projectorAt({700, 300}), {kDegreesPerCount, kDegreesPerCount});
  EXPECT_EQ(aim.measured, 0);
  // A ray tracer's answer for a small turn.
  const double beam = 2000 * std::tan(2 * 10 * kDegreesPerCount * std::numbers::pi / 180);
  const glm::dvec2 counts = aim.countsFor({beam, -beam});
  EXPECT_EQ(counts.x, 10);
  EXPECT_EQ(counts.y, 10);
  EXPECT_NEAR(viewer::centreInWall(projectorAt({700, 300})).x, 700, 1e-6);
}

TEST(MirrorAim, MeasuredMovesOverruleTheGeometry) {
  const MirrorAim geometry{.wallFromCounts = {3.6, 0, 0, -3.6}, .measured = 0};
  // Mounted on its side and the other way round.
  const glm::dmat2 truth = {0.1, 3.0, -2.8, 0.2};
  std::vector<AimPose> poses;
  for (const glm::dvec2 counts : {glm::dvec2(0, 0), glm::dvec2(100, 0), glm::dvec2(0, 100), glm::dvec2(-80, 40)}) {
    poses.push_back({counts, glm::dvec2(500, 400) + truth * counts});
  }
  const MirrorAim aim = viewer::aimByPoses(geometry, poses);
  EXPECT_EQ(aim.measured, 2);
  const glm::dvec2 wanted = {120, -60};
  EXPECT_LT(glm::length(truth * aim.countsFor(wanted) - wanted), 4);
}

TEST(MirrorAim, OneDirectionMeasuredLeavesTheOtherToTheGeometry) {
  const MirrorAim geometry{.wallFromCounts = {3.6, 0, 0, -3.6}, .measured = 0};
  const std::vector<AimPose> poses = {{{0, 0}, {0, 0}}, {{100, 0}, {-300, 0}}};
  const MirrorAim aim = viewer::aimByPoses(geometry, poses);
  EXPECT_EQ(aim.measured, 1);
  EXPECT_NEAR(aim.wallFromCounts[0][0], -3.0, 0.1);
  EXPECT_NEAR(aim.wallFromCounts[1][1], -3.6, 1e-9);
  EXPECT_EQ(viewer::aimByPoses(geometry, {}).measured, 0);
}

TEST(MirrorAim, PresetsWithCalibrationsTellPoses) {
  const TemporaryFolder folder;
  calib::Wall wall;
  wall.camera.source = "none";
  calib::ProjectorConfig config;
  config.name = "p1";
  config.resolution = {1000, 800};
  config.mirror = {"ptu", "sim:ptu", {}};
  wall.projectors.push_back(config);
  calib::saveWall(folder.path(), wall);
  for (const int pan : {0, 50}) {
    calib::Calibration calibration;
    calibration.projectors.push_back(projectorAt({700.0 + 3 * pan, 300}));
    calib::saveCalibration(folder.path(), calibration);
    calib::Preset preset;
    preset.saved = "2026-01-01T00:00:00Z";
    preset.devices.push_back({"p1.mirror", "ptu", {{"pan_counts", std::to_string(pan)}, {"tilt_counts", "7"}}});
    preset.calibration = calib::keepCalibration(folder.path());
    calib::savePreset(folder.path(), "at" + std::to_string(pan), preset);
  }
  const auto poses = viewer::posesOfPresets(folder.path());
  ASSERT_EQ(poses.at("p1").size(), 2U);
  EXPECT_EQ(poses.at("p1")[1].counts, glm::dvec2(50, 7));
  EXPECT_NEAR(poses.at("p1")[1].centreInWall.x - poses.at("p1")[0].centreInWall.x, 150, 1e-6);
}

}  // namespace
}  // namespace pixelflex::testing
