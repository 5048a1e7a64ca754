#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/procedure/verdicts.h"
#include "calib/report/wall_light.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/registration.h"

namespace pixelflex::calib {
namespace {

// From photographs to the figure in the report, against the simulated optics.
TEST(ReportOfARig, ExpectedSeamErrorIsNearTheTruth) {
  const testing::TemporaryFolder folder;
  SimulatedWall room(miniRig(2));
  const auto calibrated = calibrateRig(room, folder.path());
  const auto& projectors = calibrated.calibration.projectors;
  ASSERT_EQ(projectors.size(), 2u);
  const std::vector<ProjectorMapping> mappings(projectors.begin(), projectors.end());
  const auto meant = [&](std::size_t i, glm::dvec2 p) {
    return mappings[i].insideFrame(p) ? mappings[i].wallFromProjector(p) : std::nullopt;
  };
  const double truth = measureRegistration(room, meant).seam.rms;
  const Summary summary = summarise(calibrated.wall, calibrated.calibration);
  const double expected = seamFigures(summary.seams).rms;
  EXPECT_LT(expected, 2.5 * truth) << truth;
  EXPECT_GT(expected, truth / 2.5) << truth;
}

/// The predicted light of a uniform code on all projectors, uncorrected, over the simulated truth: root mean square of
/// what differs beyond one factor for white. Frame borders, which optics blur, do not count.
class PredictedLight : public ::testing::Test {
 protected:
  PredictedLight() : room_(miniRig(2)) {
    calibrated_ = calibrateRig(room_, folder_.path(), std::nullopt, {.uniformity = 0.5, .evenBlack = true});
    light_ = readWallLight(folder_.path(), calibrated_.wall, calibrated_.calibration).value();
  }

  [[nodiscard]] devices::ImageF truth(std::uint8_t code) const {
    std::vector<devices::Image8> frames;
    for (const auto& projector : calibrated_.calibration.projectors) {
      frames.emplace_back(projector.resolution, 3);
      std::ranges::fill(frames.back().samples(), code);
    }
    const Display& d = calibrated_.calibration.display.value();
    return room_.audienceLight(frames, {d.left, d.top}, {d.right, d.bottom}, size());
  }

  [[nodiscard]] devices::ImageF predicted(std::uint8_t code) const {
    const Display& d = calibrated_.calibration.display.value();
    const PredictedView view(light_.projectors, light_.mappings,
                             {{d.left, d.top}, (d.right - d.left) / size().width, size()});
    return view.seeField({code, code, code}, Correction::kNone);
  }

  [[nodiscard]] devices::Size size() const {
    const Display& d = calibrated_.calibration.display.value();
    return {300, static_cast<int>(300 * (d.bottom - d.top) / (d.right - d.left))};
  }

  static bool nearBorder(const devices::ImageF& field, int x, int y, int c) {
    constexpr int kReach = 3;
    float least = 1e30F, most = 0;
    for (int row = std::max(0, y - kReach); row <= std::min(field.height() - 1, y + kReach); ++row) {
      for (int column = std::max(0, x - kReach); column <= std::min(field.width() - 1, x + kReach); ++column) {
        least = std::min(least, field.at(column, row, c));
        most = std::max(most, field.at(column, row, c));
      }
    }
    return most > 1.15F * least;
  }

  /// Of predicted over true light in a channel, away from borders.
  static std::vector<double> ratios(const devices::ImageF& predicted, const devices::ImageF& truth, int c) {
    std::vector<double> all;
    for (int y = 0; y < truth.height(); ++y) {
      for (int x = 0; x < truth.width(); ++x) {
        if (!nearBorder(truth, x, y, c)) all.push_back(predicted.at(x, y, c) / truth.at(x, y, c));
      }
    }
    return all;
  }

  [[nodiscard]] double error(std::uint8_t code) const {
    double squares = 0, count = 0;
    for (int c = 0; c < 3; ++c) {
      const auto white = ratios(predicted(255), truth(255), c);
      const double factor = std::accumulate(white.begin(), white.end(), 0.0) / static_cast<double>(white.size());
      for (const double ratio : ratios(predicted(code), truth(code), c)) {
        squares += std::pow(ratio / factor - 1, 2), count += 1;
      }
    }
    EXPECT_GT(count, 3 * 0.8 * static_cast<double>(size().area()));
    return std::sqrt(squares / count);
  }

  testing::TemporaryFolder folder_;
  SimulatedWall room_;
  CalibratedRig calibrated_;
  WallLight light_;
};

TEST_F(PredictedLight, IsNearTheTruth) {
  EXPECT_TRUE(light_.matched && light_.evened && light_.leakKnown);
  const double white = error(255);
  const double grey = error(128);
  const double black = error(0);
  std::printf("white %.2f %%, grey %.2f %%, black %.2f %%\n", 100 * white, 100 * grey, 100 * black);
  EXPECT_LT(white, 0.01);
  EXPECT_LT(grey, 0.01);
  EXPECT_LT(black, 0.03);
}

}  // namespace
}  // namespace pixelflex::calib
