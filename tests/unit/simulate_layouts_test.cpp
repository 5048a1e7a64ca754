#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "calib/simulate/camera_fit.h"
#include "calib/simulate/overlap.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/stage.h"
#include "calib/store/store.h"

namespace pixelflex::calib {
namespace {

bool isInFrame(const SimulatedWall& wall, std::size_t i, glm::dvec2 pointInWall) {
  const auto pixel = wall.projectorFromWall(i, pointInWall);
  const auto size = wall.rig().projectors[i].resolution;
  return pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x < size.width && pixel->y < size.height;
}

bool isInPicture(const SimulatedWall& wall, int place, glm::dvec2 pointInWall, double border) {
  const auto pixel = wall.cameraFromWall(pointInWall, place);
  const auto size = wall.rig().camera.size;
  return pixel && pixel->x >= border && pixel->y >= border && pixel->x <= size.width - border &&
         pixel->y <= size.height - border;
}

std::vector<glm::dvec2> cornersOf(const SimulatedMarker& marker) {
  std::vector<glm::dvec2> corners;
  for (int k = 0; k < 4; ++k) {
    corners.push_back(marker.centre + 0.7 * marker.side * glm::dvec2(k % 2 * 2 - 1, k / 2 * 2 - 1));
  }
  return corners;
}

/// Markers wholly in the picture from a place.
int markersSeen(const SimulatedWall& wall, int place) {
  return static_cast<int>(std::ranges::count_if(wall.rig().markers, [&](const auto& marker) {
    return std::ranges::all_of(cornersOf(marker), [&](glm::dvec2 at) { return isInPicture(wall, place, at, 2); });
  }));
}

bool isWhollySeen(const SimulatedWall& wall, std::size_t i, int place) {
  Rig alone;
  alone.projectors = {wall.rig().projectors[i]};
  return std::ranges::all_of(frameOutlines(alone), [&](glm::dvec2 at) { return isInPicture(wall, place, at, 4); });
}

/// Camera pixels per projector pixel in the middle of a frame.
double scaleOf(const SimulatedWall& wall, std::size_t i, int place) {
  const auto size = wall.rig().projectors[i].resolution;
  const glm::dvec2 middle(0.5 * size.width, 0.5 * size.height);
  const auto at = [&](glm::dvec2 pixel) {
    return wall.cameraFromWall(wall.wallFromProjector(i, pixel).value(), place).value();
  };
  return glm::distance(at(middle), at(middle + glm::dvec2(10, 0))) / 10;
}

class Layouts : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(Layouts, CylinderOverlapsAndIsSeenWhole) {
  const Stage stage(cylinderRig(GetParam()));
  const SimulatedWall wall(stage.rig());
  ASSERT_EQ(wall.projectorCount(), 3U);
  EXPECT_EQ(wall.rig().screenRadius, 3000);
  for (std::size_t i = 0; i < 3; ++i) {
    const double width = wall.wallFromProjector(i, {1920, 540})->x - wall.wallFromProjector(i, {0, 540})->x;
    EXPECT_GT(width, 1300);
    EXPECT_LT(width, 1500);
    EXPECT_GT(scaleOf(wall, i, 0), 0.3);
    if (i == 0) continue;
    const Overlap overlap = overlapSideBySide(stage.lights()[i - 1], stage.lights()[i]);
    EXPECT_GE(overlap.least, 0.15);
    EXPECT_LE(overlap.most, 0.25);
  }
  for (const glm::dvec2 point : frameOutlines(wall.rig())) {
    EXPECT_TRUE(isInPicture(wall, 0, point, 36));
    EXPECT_TRUE(point.x > 0 && point.y > 0 && point.x < wall.rig().screenSize.x && point.y < wall.rig().screenSize.y);
  }
  EXPECT_GE(wall.rig().markers.size(), 8U);
  EXPECT_EQ(markersSeen(wall, 0), static_cast<int>(wall.rig().markers.size()));
}

TEST_P(Layouts, LargeWallIsSeenFromItsPlacesTogether) {
  const SimulatedWall wall(largeRig(GetParam()));
  ASSERT_EQ(wall.projectorCount(), 18U);
  ASSERT_EQ(wall.placeCount(), 6);
  int often = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    int places = 0;
    for (int place = 0; place < 6; ++place) {
      if (!isWhollySeen(wall, i, place)) continue;
      ++places;
      EXPECT_GT(scaleOf(wall, i, place), 0.43);
      EXPECT_LT(scaleOf(wall, i, place), 0.65);
    }
    EXPECT_GE(places, 1) << wall.rig().projectors[i].name;
    EXPECT_LT(places, 6);
    often += places > 1 ? 1 : 0;
  }
  EXPECT_GE(often, 10);
}

TEST_P(Layouts, LargeWallHasMarkersForEveryPlace) {
  const SimulatedWall wall(largeRig(GetParam()));
  std::set<int> ids;
  for (const auto& marker : wall.rig().markers) {
    ids.insert(marker.aruco);
    for (std::size_t i = 0; i < wall.projectorCount(); ++i) EXPECT_FALSE(isInFrame(wall, i, marker.centre));
  }
  EXPECT_EQ(ids.size(), 18U);
  int four = 0;
  for (int place = 0; place < 6; ++place) {
    EXPECT_GE(markersSeen(wall, place), 3);
    four += markersSeen(wall, place) >= 4 ? 1 : 0;
  }
  EXPECT_GE(four, 4);
}

TEST_P(Layouts, IslandsLieApart) {
  const Stage stage(islandsRig(GetParam()));
  const SimulatedWall wall(stage.rig());
  ASSERT_EQ(wall.projectorCount(), 4U);
  const auto& lights = stage.lights();
  EXPECT_GT(overlapSideBySide(lights[0], lights[1]).least, 0.05);
  EXPECT_GT(overlapSideBySide(lights[2], lights[3]).least, 0.05);
  double leftEnd = -1e9;
  double rightStart = 1e9;
  for (double y = 0; y <= 768; y += 16) {
    leftEnd = std::max(leftEnd, wall.wallFromProjector(1, {1024, y})->x);
    rightStart = std::min(rightStart, wall.wallFromProjector(2, {0, y})->x);
  }
  EXPECT_GT(rightStart - leftEnd, 100);
  for (const glm::dvec2 point : frameOutlines(wall.rig())) EXPECT_TRUE(isInPicture(wall, 0, point, 36));
}

TEST_P(Layouts, LShapeLeavesACornerDark) {
  const Stage stage(lShapedRig(GetParam()));
  const SimulatedWall wall(stage.rig());
  ASSERT_EQ(wall.projectorCount(), 3U);
  EXPECT_GT(overlapOneAboveOther(stage.lights()[0], stage.lights()[1]).least, 0.05);
  EXPECT_GT(overlapSideBySide(stage.lights()[1], stage.lights()[2]).least, 0.05);
  const glm::dvec2 dark(wall.wallFromProjector(2, {512, 384})->x, wall.wallFromProjector(0, {512, 384})->y);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(isInFrame(wall, i, dark));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Layouts, ::testing::Values(1U, 2U, 3U, 4U, 5U));

TEST(SimulateRig, ThirtyTwoProjectorsFitOnePicture) {
  const SimulatedWall wall(casualRig(8, 4, {640, 480}, 1, {3840, 2160}));
  ASSERT_EQ(wall.projectorCount(), 32U);
  for (const glm::dvec2 point : frameOutlines(wall.rig())) ASSERT_TRUE(isInPicture(wall, 0, point, 36));
  EXPECT_GT(scaleOf(wall, 13, 0), 0.6);
}

TEST(SimulateRig, BentScreensAndPlacesSurviveTheFile) {
  for (const Rig& rig : {cylinderRig(4), largeRig(4)}) EXPECT_EQ(parseRig(formatRig(rig), "rig.yaml"), rig);
  Rig bulging = cylinderRig(4);
  bulging.screenRadius = -2500.25;
  bulging.cameraPlaces = {Pose{{1, 2, -3000}, {4, 5, 6}}};
  EXPECT_EQ(parseRig(formatRig(bulging), "rig.yaml"), bulging);
  const std::string plain = formatRig(miniRig(2));
  EXPECT_EQ(plain.find("radius"), std::string::npos);
  EXPECT_EQ(plain.find("places"), std::string::npos);
}

TEST(SimulateRig, ScreensThatReachTooFarRoundAndPlacesBehindTheWallAreRefused) {
  const std::string start = "format: pixelflex-rig\nversion: 1\nprojectors: [{}]\n";
  EXPECT_THROW((void)parseRig(start + "screen: {size: [3000, 1000], radius: 1000}\n", "rig.yaml"), StoreError);
  EXPECT_THROW((void)parseRig(start + "screen: {radius: .nan}\n", "rig.yaml"), StoreError);
  EXPECT_NO_THROW((void)parseRig(start + "screen: {size: [2700, 1000], radius: -1000}\n", "rig.yaml"));
  EXPECT_THROW((void)parseRig(start + "camera: {places: [{position: [0, 0, 10]}]}\n", "rig.yaml"), StoreError);
  EXPECT_THROW((void)parseRig(start + "camera: {places: [{focal: 10}]}\n", "rig.yaml"), StoreError);
  EXPECT_EQ(parseRig(start + "camera: {places: [{}, {rotation: [9, 0, 0]}]}\n", "rig.yaml").cameraPlaces.size(), 2U);
}

TEST(SimulateRig, TheOwnerOfACurvedScreenKnowsItsRadius) {
  const Wall wall = wallOfRig(cylinderRig(1), "rig.yaml");
  EXPECT_EQ(wall.surface.shape, SurfaceShape::kCylinder);
  EXPECT_EQ(wall.surface.cylinderRadius, 3000);
  EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall);
}

}  // namespace
}  // namespace pixelflex::calib
