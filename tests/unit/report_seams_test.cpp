#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "calib/estimate/projector_fit.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/procedure/seams.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

/// A rig's projectors measured at 10 x 10 points of their frames against the simulated optics, each point's place on
/// the wall off by normal noise of `noisePx` projector pixels along each axis.
class MeasuredRig {
 public:
  MeasuredRig(Rig rig, double noisePx, std::uint32_t seed, double wavePx = 0)
      : room_(std::move(rig)), wavePx_(wavePx), random_(seed) {
    for (std::size_t i = 0; i < room_.projectorCount(); ++i) measure(i, noisePx);
    calibration_.display = Display{-1e5, -1e5, 1e5, 1e5, {100000, 100000}};
  }
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }

  /// The rms of the seam error between two projectors against the truth, in pixels of the coarser.
  [[nodiscard]] double trueSeam(const Seam& seam) const {
    const std::size_t a = indexOf(seam.first);
    const std::size_t b = indexOf(seam.second);
    const ProjectorMapping ofA(calibration_.projectors[a]);
    const ProjectorMapping ofB(calibration_.projectors[b]);
    const double density = std::min(ofA.meanDensity(), ofB.meanDensity());
    const devices::Size size = ofA.resolution();
    double squares = 0;
    int count = 0;
    for (double y = 4; y < size.height; y += 8) {
      for (double x = 4; x < size.width; x += 8) {
        const auto inWall = landing(a, {x, y});
        auto inB = inWall ? room_.projectorFromWall(b, *inWall) : std::nullopt;
        if (!inB || !ofB.insideFrame(*inB)) continue;
        inB = *inB - wave(b, *inB);
        const glm::dvec2 apart = ofA.wallFromProjector({x, y}).value() - ofB.wallFromProjector(*inB).value();
        squares += glm::dot(apart, apart) * density * density;
        ++count;
      }
    }
    return std::sqrt(squares / count);
  }

 private:
  /// Every second projector has a waviness that no lens model follows.
  [[nodiscard]] glm::dvec2 wave(std::size_t i, glm::dvec2 p) const {
    return i % 2 == 0 ? glm::dvec2(wavePx_ * std::sin(p.x / 130) * std::cos(p.y / 110), 0) : glm::dvec2(0, 0);
  }
  [[nodiscard]] std::optional<glm::dvec2> landing(std::size_t i, glm::dvec2 p) const {
    return room_.wallFromProjector(i, p + wave(i, p));
  }
  void measure(std::size_t i, double noisePx) {
    const auto& config = room_.rig().projectors[i];
    std::normal_distribution<double> noise(0, noisePx);
    ProjectorCalibration projector{.name = config.name, .resolution = config.resolution};
    for (int k = 0; k < 100; ++k) {
      const glm::dvec2 p = glm::dvec2(config.resolution.width, config.resolution.height) *
                           glm::dvec2(0.02 + 0.96 * (k % 10) / 9, 0.02 + 0.96 * static_cast<int>(k / 10) / 9);
      projector.samples.push_back({p, landing(i, p + glm::dvec2(noise(random_), noise(random_))).value()});
    }
    const ProjectorFit fit = fitProjector(projector.samples, projector.resolution);
    projector.model = fit.model;
    projector.quality = fit.quality;
    if (wavePx_ > 0) leaveWaves(projector);
    calibration_.projectors.push_back(projector);
  }

  /// The model without the correction that would follow the waves.
  static void leaveWaves(ProjectorCalibration& projector) {
    projector.model.residual.reset();
    const ProjectorMapping mapping(projector);
    double squares = 0;
    for (const auto& sample : projector.samples) {
      const glm::dvec2 error = mapping.projectorFromWall(sample.pointInWall).value() - sample.pointInProjector;
      squares += glm::dot(error, error);
    }
    projector.quality.rms = std::sqrt(squares / static_cast<double>(projector.samples.size()));
  }

  [[nodiscard]] std::size_t indexOf(const std::string& name) const {
    const auto& all = calibration_.projectors;
    return static_cast<std::size_t>(std::ranges::find(all, name, &ProjectorCalibration::name) - all.begin());
  }

  SimulatedWall room_;
  double wavePx_;
  std::mt19937 random_;
  Calibration calibration_;
};

/// Expected over true seam error, rms over all overlaps.
double expectedOverTrue(const MeasuredRig& rig) {
  double expected = 0, truth = 0;
  for (const Seam& seam : findSeams(rig.calibration())) {
    expected += seam.expectedRms * seam.expectedRms;
    truth += std::pow(rig.trueSeam(seam), 2);
    EXPECT_GE(seam.expectedWorst, seam.expectedRms);
  }
  return std::sqrt(expected / truth);
}

TEST(Seams, ExpectedErrorIsNearTheTruthForNoise) {
  for (const std::uint32_t seed : {1U, 2U}) {
    const double ratio = expectedOverTrue(MeasuredRig(reportRig(seed), 0.05 * seed, seed));
    EXPECT_LT(ratio, 1.8);
    EXPECT_GT(ratio, 1 / 1.8);
  }
}

TEST(Seams, ExpectedErrorIsNearTheTruthWhereTheModelDoesNotFollow) {
  const double ratio = expectedOverTrue(MeasuredRig(reportRig(3), 0.02, 3, 0.5));
  EXPECT_LT(ratio, 1.8);
  EXPECT_GT(ratio, 1 / 1.8);
}

/// Two square projectors of 1000 x 1000 pixels at one pixel a unit, the second moved right by 900 and turned a little,
/// exact but for what the tests add.
Calibration twoSquares(double shift) {
  Calibration calibration;
  for (int i = 0; i < 2; ++i) {
    ProjectorCalibration projector{.name = i == 0 ? "left" : "right", .resolution = {1000, 1000}};
    projector.model.projectorFromWall = {1, 0, -i * shift, 0, 1, 0, 0, 0, 1};
    for (int k = 0; k < 100; ++k) {
      const glm::dvec2 p(50 + 100 * (k % 10), 50 + 100 * static_cast<int>(k / 10));
      projector.samples.push_back({p, p + glm::dvec2(i * shift, 0)});
    }
    calibration.projectors.push_back(projector);
  }
  calibration.display = Display{0, 0, 1000 + shift, 1000, {static_cast<int>(1000 + shift), 1000}};
  return calibration;
}

TEST(Seams, WidthAndShareOfAnOverlapAreExact) {
  const auto seams = findSeams(twoSquares(900));
  ASSERT_EQ(seams.size(), 1u);
  EXPECT_EQ(seams[0].first, "left");
  EXPECT_EQ(seams[0].second, "right");
  EXPECT_NEAR(seams[0].overlapPercent, 10, 0.01);
  EXPECT_NEAR(seams[0].narrowest, 100, 3);
  EXPECT_EQ(seams[0].sharedPercent, 0);
  EXPECT_NEAR(seams[0].densityRatio, 1, 1e-9);
  EXPECT_EQ(seams[0].expectedRms, 0) << "nothing was off";
}

TEST(Seams, TheNarrowEndOfAWedgeCounts) {
  Calibration calibration = twoSquares(900);
  // The second projector leans: 100 wide at the top, 20 at the bottom.
  calibration.projectors[1].model.projectorFromWall = {1, -0.08, -900, 0, 1, 0, 0, 0, 1};
  const auto seams = findSeams(calibration);
  ASSERT_EQ(seams.size(), 1u);
  EXPECT_NEAR(seams[0].narrowest, 28, 4);  // nine tenths down
  EXPECT_NEAR(seams[0].overlapPercent, 6, 0.2);
}

TEST(Seams, AModelThatIsWrongByAPixelIsSeenAtTheSeam) {
  Calibration calibration = twoSquares(900);
  calibration.projectors[1].model.projectorFromWall[2] += 1;
  calibration.projectors[1].quality = {.rms = 1, .p95 = 1, .maximum = 1, .found = 100, .shown = 100};
  EXPECT_NEAR(findSeams(calibration).at(0).expectedRms, 1, 0.5);
}

TEST(Seams, ApartOrOutsideTheDisplayThereIsNothingToSee) {
  EXPECT_TRUE(findSeams(twoSquares(1001)).empty());
  EXPECT_TRUE(findSeams({}).empty());
  Calibration calibration = twoSquares(900);
  calibration.display = Display{0, 0, 500, 500, {500, 500}};
  const auto seams = findSeams(calibration);
  ASSERT_EQ(seams.size(), 1u);
  EXPECT_FALSE(seams[0].insideDisplay);
  EXPECT_EQ(seams[0].narrowest, 0);
}

TEST(Seams, AThirdProjectorSharesTheOverlap) {
  Calibration calibration = twoSquares(900);
  ProjectorCalibration third = calibration.projectors[0];
  third.name = "over";
  third.model.projectorFromWall = {1, 0, -500, 0, 1, -500, 0, 0, 1};
  calibration.projectors.push_back(third);
  const auto seams = findSeams(calibration);
  ASSERT_EQ(seams.size(), 3u);
  EXPECT_NEAR(seams[0].sharedPercent, 50, 1);
}

}  // namespace
}  // namespace pixelflex::calib
