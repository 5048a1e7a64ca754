#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "calib/simulate/camera_fit.h"
#include "calib/simulate/overlap.h"
#include "calib/simulate/planar_screen.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

std::string problemsOf(const std::string& text) {
  try {
    (void)parseRig(text, "rig.yaml");
  } catch (const StoreError& error) {
    return error.what();
  }
  return "";
}

TEST(SimulateRigFile, FormatsToTextThatParsesBack) {
  Rig rig = casualRig(3, 2, {1280, 800}, 4711);
  rig.room = {0.0125, 1.0 / 3, 0.1};
  rig.camera.gamma = 2.2;
  rig.projectors[1].name = "left-2.a";
  EXPECT_EQ(parseRig(formatRig(rig), "rig.yaml"), rig);
  rig.markers.clear();
  EXPECT_EQ(parseRig(formatRig(rig), "rig.yaml"), rig);
}

TEST(SimulateRigFile, ShippedRigsAreTheGenerators) {
  const std::filesystem::path folder = std::filesystem::path(PIXELFLEX_SOURCE_DIR) / "config" / "rigs";
  EXPECT_EQ(loadRig(folder / "report-8.yaml"), reportRig(8));
  EXPECT_EQ(loadRig(folder / "mini-2.yaml"), miniRig(2));
  EXPECT_EQ(loadRig(folder / "cylinder-3.yaml"), cylinderRig(1));
  EXPECT_EQ(loadRig(folder / "large-18.yaml"), largeRig(1));
}

TEST(SimulateRigFile, ShortFormHasUsableDefaults) {
  const Rig rig = parseRig("format: pixelflex-rig\nversion: 1\nprojectors:\n  - {}\n  - {name: right}\n", "rig.yaml");
  ASSERT_EQ(rig.projectors.size(), 2U);
  EXPECT_EQ(rig.projectors[0].name, "p1");
  EXPECT_EQ(rig.projectors[1].name, "right");
  EXPECT_EQ(rig.camera.size, (devices::Size{1920, 1080}));
  const SimulatedWall wall(rig);
  const auto middle = wall.wallFromProjector(0, {512, 384});
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x, 1500, 1e-6);
  EXPECT_NEAR(middle->y, 750, 1e-6);
  EXPECT_NEAR(wall.wallFromProjector(0, {0, 384})->x, 0, 1e-6);  // just as wide as the screen
  EXPECT_TRUE(wall.cameraFromWall({0, 0}));
}

TEST(SimulateRigFile, NamesEveryProblemAtOnce) {
  const std::string text =
      "format: pixelflex-rig\nversion: 1\nroom: {gradient: 3}\nscren: {}\ncamera: {position: [0, 0, 5]}\n"
      "markers: [{aruco: 3}, {aruco: 3}, {aruco: 50}]\n"
      "projectors:\n  - {name: a, vignetting: 2, response: {toe: 0.5}}\n  - {name: a, radial: [-3, 0, 0]}\n";
  const std::string problems = problemsOf(text);
  EXPECT_THAT(problems, HasSubstr("gradient"));
  EXPECT_THAT(problems, HasSubstr("scren"));
  EXPECT_THAT(problems, HasSubstr("z must be negative"));
  EXPECT_THAT(problems, HasSubstr("two markers have aruco id 3"));
  EXPECT_THAT(problems, HasSubstr("vignetting"));
  EXPECT_THAT(problems, HasSubstr("toe"));
  EXPECT_THAT(problems, HasSubstr("folds back"));
  EXPECT_THAT(problems, HasSubstr("rig.yaml:9"));
}

TEST(SimulateRigFile, RefusesOtherFiles) {
  EXPECT_NE(problemsOf(""), "");
  EXPECT_NE(problemsOf("format: pixelflex-wall\nversion: 1\n"), "");
  EXPECT_NE(problemsOf("format: pixelflex-rig\nversion: 99\nprojectors: [{}]\n"), "");
  EXPECT_NE(problemsOf("format: pixelflex-rig\nversion: 1\nprojectors: []\n"), "");
  EXPECT_NE(problemsOf("format: pixelflex-rig\nversion: 1\nprojectors: [{resolution: [0, 5], focal: .nan}]\n"), "");
  EXPECT_NE(problemsOf("format: pixelflex-rig\nversion: 1\ncamera: 3\nprojectors: 4\n"), "");
  EXPECT_THROW((void)loadRig("/nowhere/rig.yaml"), StoreError);
}

class CasualRigs : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(CasualRigs, NeighboursOverlapByTenToThirtyPerCent) {
  const Rig rig = reportRig(GetParam());
  ASSERT_EQ(rig.projectors.size(), 8U);
  const PlanarScreen screen;
  const auto light = [&](std::size_t i) { return ProjectorLight(rig.projectors[i], screen); };
  const auto check = [](Overlap overlap, std::size_t a, std::size_t b) {
    EXPECT_GE(overlap.least, 0.1) << a << " and " << b;
    EXPECT_LE(overlap.most, 0.3) << a << " and " << b;
  };
  for (std::size_t i = 0; i < 8; ++i) {
    if (i % 4 < 3) check(overlapSideBySide(light(i), light(i + 1)), i, i + 1);
    if (i < 4) check(overlapOneAboveOther(light(i), light(i + 4)), i, i + 4);
  }
}

TEST_P(CasualRigs, LeaveNoHoleBetweenTheProjectors) {
  const SimulatedWall wall(reportRig(GetParam()));
  // The middles of the outermost frames span the inside: every point of it must be lit.
  glm::dvec2 low(-1e9);
  glm::dvec2 high(1e9);
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec2 middle = wall.wallFromProjector(i, {512, 384}).value();
    if (i % 4 == 0) low.x = std::max(low.x, middle.x);
    if (i % 4 == 3) high.x = std::min(high.x, middle.x);
    (i < 4 ? low.y : high.y) = i < 4 ? std::max(low.y, middle.y) : std::min(high.y, middle.y);
  }
  for (double y = low.y; y <= high.y; y += 8) {
    for (double x = low.x; x <= high.x; x += 8) {
      bool lit = false;
      for (std::size_t i = 0; i < 8 && !lit; ++i) {
        const auto pixel = wall.projectorFromWall(i, {x, y});
        lit = pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x < 1024 && pixel->y < 768;
      }
      ASSERT_TRUE(lit) << x << ", " << y;
    }
  }
}

TEST_P(CasualRigs, CameraSeesEverythingWithABorder) {
  const SimulatedWall wall(reportRig(GetParam()));
  WallBounds seen;
  for (const glm::dvec2 point : frameOutlines(wall.rig())) seen.include(wall.cameraFromWall(point).value());
  for (const auto& marker : wall.rig().markers) {
    for (int k = 0; k < 4; ++k) {
      const glm::dvec2 corner = marker.centre + 0.7 * marker.side * glm::dvec2(k % 2 * 2 - 1, k / 2 * 2 - 1);
      seen.include(wall.cameraFromWall(corner).value());
    }
  }
  EXPECT_GT(seen.low.x, 36);
  EXPECT_GT(seen.low.y, 36);
  EXPECT_LT(seen.high.x, 1920 - 36);
  EXPECT_LT(seen.high.y, 1080 - 36);
  EXPECT_GT(seen.high.x - seen.low.x, 1700);  // and uses the picture
}

TEST_P(CasualRigs, ProjectorsDifferWithinMeasuredBounds) {
  const Rig rig = reportRig(GetParam());
  for (const auto& projector : rig.projectors) {
    EXPECT_LE(std::abs(projector.pose.rotation.x), 8);
    EXPECT_LE(std::abs(projector.pose.rotation.y), 8);
    EXPECT_LE(std::abs(projector.pose.rotation.z), 2.5);
    EXPECT_GE(std::abs(projector.optics.radial[0]), 0.0199);
    EXPECT_LE(std::abs(projector.optics.radial[0]), 0.0501);
    EXPECT_NEAR(projector.lumens, 1500, 226);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(projector.response.gain.at(channel), 1, 0.081);
      EXPECT_NEAR(projector.response.gamma.at(channel), 2.2, 0.31);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CasualRigs, ::testing::Values(1U, 2U, 8U, 77U, 2024U));

TEST(SimulateRig, MarkersHangOutsideThePicture) {
  for (const Rig& rig : {reportRig(8), miniRig(2)}) {
    const SimulatedWall wall(rig);
    for (const auto& marker : rig.markers) {
      for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
        const auto pixel = wall.projectorFromWall(i, marker.centre);
        const auto size = rig.projectors[i].resolution;
        EXPECT_FALSE(pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x < size.width && pixel->y < size.height);
      }
    }
  }
}

TEST(SimulateRig, OwnerWritesAValidWall) {
  const Rig rig = reportRig(8);
  const Wall wall = wallOfRig(rig, "rig.yaml");
  EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall);
  ASSERT_EQ(wall.projectors.size(), 8U);
  EXPECT_EQ(wall.projectors[3].name, "p4");
  EXPECT_EQ(wall.projectors[3].output.kind, OutputKind::kSim);
  EXPECT_EQ(wall.projectors[3].gamma, "readings/p4.csv");
  EXPECT_EQ(wall.camera.source, "sim");
  EXPECT_EQ(wall.rig, "rig.yaml");
  ASSERT_EQ(wall.surface.fiducials.size(), 6U);
  EXPECT_EQ(wall.surface.fiducials[2].pointInWall, rig.markers[2].centre);
}

TEST(SimulateRig, ReadingsFollowTheResponse) {
  const auto spec = reportRig(8).projectors[2];
  std::istringstream lines(readingsOfProjector(spec, 5));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "value,red,green,blue");
  double white = 0;
  double worst = 0;
  for (const int pass : {0, 1}) {
    lines.clear();
    lines.str(readingsOfProjector(spec, 5));
    std::getline(lines, line);
    for (int code = 0; code < 256; ++code) {
      ASSERT_TRUE(std::getline(lines, line));
      int value = -1;
      double red = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf", &value, &red), 2);
      ASSERT_EQ(value, code);
      if (code == 255) white = red;
      if (pass == 0) continue;
      const double expected = channelLight(spec.response, 0, code / 255.0) / channelLight(spec.response, 0, 1);
      worst = std::max(worst, std::abs(red / white / expected - 1));
    }
  }
  EXPECT_LT(worst, 0.02);  // five deviations of two noisy readings of 0.2 %, and the digits of the dark ones
  EXPECT_GT(worst, 0.001);
}

}  // namespace
}  // namespace pixelflex::calib
