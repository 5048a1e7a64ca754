#include "tests/accuracy/light_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "calib/simulate/rig_generator.h"
#include "tests/accuracy/light_rigs.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

/// Two projectors and a display across both, painted by hand: what is measured is known.
class LightMeasures : public ::testing::Test {
 protected:
  using Light = std::function<double(glm::dvec2 pointInWall)>;

  [[nodiscard]] ImageF paint(const Light& light, int channels = 1) const {
    ImageF image({kWidth / 2, kHeight / 2}, channels);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const auto value = static_cast<float>(light(topLeft_ + kPitch * 2 * glm::dvec2(x + 0.5, y + 0.5)));
        for (int c = 0; c < channels; ++c) image.at(x, y, c) = value;
      }
    }
    return image;
  }

  [[nodiscard]] bool lights(std::size_t projector, glm::dvec2 pointInWall) const {
    const auto p = room_.projectorFromWall(projector, pointInWall);
    return p && p->x > 0 && p->y > 0 && p->x < 640 && p->y < 480;
  }

  static Display displayFrom(glm::dvec2 topLeft) {
    return {topLeft.x, topLeft.y, topLeft.x + kPitch * kWidth, topLeft.y + kPitch * kHeight, {kWidth, kHeight}};
  }

  static constexpr int kWidth = 800;
  static constexpr int kHeight = 300;
  static constexpr double kPitch = 2;  // mm per desktop pixel
  SimulatedWall room_{miniRig(2)};
  /// The display's middle is that of the overlap.
  glm::dvec2 topLeft_ =
      0.5 * (room_.wallFromProjector(0, {620, 240}).value() + room_.wallFromProjector(1, {20, 240}).value()) -
      0.5 * kPitch * glm::dvec2(kWidth, kHeight);
  WallView view_{room_, displayFrom(topLeft_), 2};
};

TEST_F(LightMeasures, FindAStepAtATrueBorderOnly) {
  ASSERT_FALSE(view_.borders().empty());
  const auto step = largestStep(view_, paint([&](glm::dvec2 p) { return lights(0, p) ? 1.02 : 1.0; }));
  EXPECT_NEAR(step.step, 0.02, 0.002);
  EXPECT_EQ(step.projector, 0U);
  const auto slope = paint([&](glm::dvec2 p) { return 1 + 0.002 * (p.x - topLeft_.x); });
  EXPECT_LT(largestStep(view_, slope).step, 1e-4);
  const auto bend = paint([&](glm::dvec2 p) { return 1 + 1e-6 * std::pow(p.x - topLeft_.x, 2); });
  EXPECT_LT(largestStep(view_, bend).step, 1e-3);
}

TEST_F(LightMeasures, TellUnevennessAndSlopePerDegree) {
  const double degree = kPitch * kWidth / kDisplayDegrees;
  const auto slope = paint([&](glm::dvec2 p) { return std::exp(0.02 * (p.x - topLeft_.x) / degree); });
  EXPECT_NEAR(steepestPerDegree(view_, slope).change, 0.02, 0.0002);
  EXPECT_LT(steepestPerDegree(view_, paint([](glm::dvec2) { return 3.0; })).change, 1e-5);
  const auto halves = paint([&](glm::dvec2 p) { return p.x < topLeft_.x + kPitch * kWidth / 2 ? 0.98 : 1.02; });
  EXPECT_NEAR(unevenness(halves), 0.02, 1e-5);
}

TEST_F(LightMeasures, CountProjectorsForTheBlackStep) {
  const auto black = paint([&](glm::dvec2 p) { return lights(0, p) && lights(1, p) ? 0.0206 : 0.02; });
  EXPECT_NEAR(blackStep(view_, black), 0.03, 0.0005);
}

TEST_F(LightMeasures, FindBandsInTheBlendAndNotWhatWhiteHasToo) {
  const auto shape = [&](glm::dvec2 p) { return 1 + 0.1 * std::sin(0.01 * (p.x - topLeft_.x)); };
  const auto black = paint([](glm::dvec2) { return 0.004; });
  const auto white = paint(shape);
  const auto banded = [&](double depth) {
    return paint([&, depth](glm::dvec2 p) {
      const double grey = 0.004 + 0.05 * (shape(p) - 0.004);
      return grey * (1 + (std::fmod(p.x - topLeft_.x, 32) < 16 ? depth : -depth));
    });
  };
  EXPECT_LT(banding(view_, {black, white, banded(0), 0.05}), 2e-3);
  EXPECT_NEAR(banding(view_, {black, white, banded(0.02), 0.05}), 0.02, 0.002);
}

TEST_F(LightMeasures, CompareColoursOfFrames) {
  const auto light = paint([&](glm::dvec2 p) { return p.x < topLeft_.x + kPitch * kWidth / 2 ? 0.25 : 0.5; }, 3);
  EXPECT_NEAR(colourOfProjector(view_, light, 0).y, 0.25, 1e-6);
  EXPECT_NEAR(colourOfProjector(view_, light, 1).y, 0.5, 1e-6);
  EXPECT_NEAR(meanColour(light).z, 0.375, 1e-6);
  const glm::dvec3 white(1);
  EXPECT_EQ(colourDifference({{0.2, 0.2, 0.2}, {0.2, 0.2, 0.2}}, white), 0);
  // L* of 0.18 and of 0.2 of white: 49.50 and 51.84; at the same lightness scale as theirs, 2.3 apart.
  EXPECT_NEAR(colourDifference({{0.18, 0.18, 0.18}, {0.2, 0.2, 0.2}}, white), 2.34, 0.03);
}

TEST(LightRigs, AreAsUnlikeAsTheyShouldBe) {
  for (const auto& kind : lightRigs()) {
    for (const auto& projector : kind.make(7).projectors) {
      EXPECT_NEAR(projector.lumens, 1500, 225);
      EXPECT_TRUE(projector.vignetting >= 0.2 && projector.vignetting <= 0.4);
      EXPECT_TRUE(projector.response.black >= 0.001 && projector.response.black <= 0.004);
      EXPECT_GT(projector.response.toe, 0);
      for (const double gamma : projector.response.gamma) EXPECT_TRUE(gamma >= 1.9 && gamma <= 2.5);
      for (const double gain : projector.response.gain) EXPECT_NEAR(gain, 1, 0.08);
    }
  }
}

TEST(LightRigs, SlipEveryOtherProjector) {
  const SimulatedWall room(miniRig(1));
  const SimulatedWall moved(slipped(room.rig(), 0.3));
  const auto place = room.wallFromProjector(1, {100, 100}).value_or(glm::dvec2(0));
  EXPECT_NEAR(moved.projectorFromWall(1, place).value_or(glm::dvec2(0)).x, 100.3, 0.002);
  EXPECT_EQ(moved.rig().projectors[0], room.rig().projectors[0]);
}

}  // namespace
}  // namespace pixelflex::calib
