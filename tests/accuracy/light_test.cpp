#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "calib/geometry/projector_mapping.h"
#include "calib/simulate/rig_generator.h"
#include "devices/display/gl_context.h"
#include "devices/image/png_file.h"
#include "tests/gl/plans.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::calib {
namespace {

/// Light of the wall as the audience sees it: unevenness and differences of colour inside the display.
struct Evenness {
  double luminance = 0;  // rms over mean
  double redOverGreen = 0;
  double blueOverGreen = 0;
  double mean = 0;
};

double linear(int code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

struct Spread {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double relative() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean())) / mean(); }
};

/// Means over blocks, so that the audience's eight bits do not count as unevenness.
Evenness evennessOf(const devices::Image8& view) {
  constexpr int kBlock = 8;
  Spread luminance, red, blue;
  for (int y = 0; y + kBlock <= view.height(); y += kBlock) {
    for (int x = 0; x + kBlock <= view.width(); x += kBlock) {
      std::array<double, 3> sum{};
      for (int k = 0; k < kBlock * kBlock; ++k) {
        for (int c = 0; c < 3; ++c) {
          sum[static_cast<std::size_t>(c)] += linear(view.at(x + k % kBlock, y + k / kBlock, c));
        }
      }
      luminance.add(0.2126 * sum[0] + 0.7152 * sum[1] + 0.0722 * sum[2]);
      red.add(sum[0] / sum[1]);
      blue.add(sum[2] / sum[1]);
    }
  }
  return {luminance.relative(), red.relative(), blue.relative(), luminance.mean() / (kBlock * kBlock)};
}

class LightTest : public ::testing::Test {
 protected:
  /// The audience's view of the display, one grey on the desktop, through calibration and renderer.
  [[nodiscard]] Evenness grey(const Blend& blend, std::uint8_t code) {
    const testing::TemporaryFolder folder;
    const auto [wall, calibration, warnings] = calibrateRig(room_, folder.path(), Method::kBlobs, blend);
    const viewer::WallPlan plan(folder.path(), wall, calibration, {});
    devices::HeadlessContext context;
    viewer::WallRenderer renderer(context, {});
    renderer.setPlans(plan.outputsFor(plan.desktop()));
    devices::Image8 desktop(plan.desktop(), 4);
    std::ranges::fill(desktop.samples(), code);
    renderer.upload(testing::wholeBatch(desktop));
    renderer.draw();
    std::vector<devices::Image8> frames;
    for (std::size_t i = 0; i < renderer.outputCount(); ++i) frames.push_back(renderer.readOutput(i));
    const Display& d = *calibration.display;
    const glm::dvec2 inset = 0.01 * glm::dvec2(d.right - d.left, d.bottom - d.top);
    return evennessOf(room_.audience(frames, glm::dvec2(d.left, d.top) + inset, glm::dvec2(d.right, d.bottom) - inset,
                                     {800, 300}, kExposure));
  }

  static constexpr double kExposure = 0.4;  // brightens a grey of 128 to the middle of the audience's codes
  SimulatedWall room_{casualRig(3, 1, {640, 480}, 4, {1280, 720})};
};

TEST_F(LightTest, MatchingMakesOneWallOfThree) {
  const Evenness before = grey({}, 128);
  const Evenness after = grey({.uniformity = 1}, 128);
  std::printf(
      "grey 128, rms: luminance %.2f %% -> %.2f %%, red/green %.2f %% -> %.2f %%, blue/green %.2f %% -> %.2f %%; "
      "%.0f %% of the light kept\n",
      100 * before.luminance, 100 * after.luminance, 100 * before.redOverGreen, 100 * after.redOverGreen,
      100 * before.blueOverGreen, 100 * after.blueOverGreen, 100 * after.mean / before.mean);
  EXPECT_LT(after.luminance, 0.02);
  EXPECT_LT(after.redOverGreen, 0.01);
  EXPECT_LT(after.blueOverGreen, 0.01);
  EXPECT_GT(before.luminance, 3 * after.luminance);
  EXPECT_GT(after.mean, 0.4 * before.mean);
}

}  // namespace
}  // namespace pixelflex::calib
