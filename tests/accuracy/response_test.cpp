// The responses that the camera measures, against those that the simulated projectors have.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "calib/capture/live_photographs.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/response_step.h"
#include "calib/procedure/white_photographs.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/response_error.h"

namespace pixelflex::calib {
namespace {

/// Responses from the whole range that projectors have.
void drawResponses(Rig& rig, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  rig.seed = seed;
  for (auto& projector : rig.projectors) {
    for (double& gamma : projector.response.gamma) gamma = between(1.9, 2.5);
    for (double& gain : projector.response.gain) gain = between(0.92, 1.08);
    projector.response.toe = between(0, 0.04);
    projector.response.black = between(0.001, 0.004);
    projector.vignetting = between(0.2, 0.4);
    projector.lumens *= between(0.85, 1.15);
  }
}

class ResponseAccuracy : public ::testing::Test {
 protected:
  void SetUp() override {
    SimulatedWall room(rig_);
    auto calibrated = calibrateRig(room, folder_.path(), Method::kBlobs);
    wall_ = calibrated.wall;
    calibration_ = calibrated.calibration;
    for (auto& projector : wall_.projectors) {
      projector.gamma.reset();
      projector.gammaByCamera = true;
    }
  }

  /// The light of white of both projectors, as a camera of this curve makes of its photographs.
  [[nodiscard]] std::vector<PhotographedLight> whiteSeen(SimulatedWall& room, const CameraResponse& camera) {
    std::vector<devices::Projector*> projectors;
    for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
    LivePhotographs photographs(room.camera(), projectors, room.person(), {}, "test", 0);
    return photographLight(calibration_, camera, Method::kBlobs, 24, photographs, progress_);
  }

  [[nodiscard]] ResponseResult measure(SimulatedWall& room, std::size_t projector) {
    std::vector<devices::Projector*> projectors;
    for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
    LivePhotographs photographs(room.camera(), projectors, room.person(), {}, "test", 0);
    return measureResponses(wall_, calibration_, {rig_.projectors[projector].name}, photographs, progress_,
                            [](const std::string&, const std::string& problem) { throw ProcedureError(problem); });
  }

  testing::TemporaryFolder folder_;
  Rig rig_ = casualRig(2, 1, {320, 240}, 3, {640, 360});
  Wall wall_;
  Calibration calibration_;
  RecordedProgress progress_;
};

/// How differently two measurements see the same light, apart from its scale: RMS of their ratio, green channel.
double differenceOf(const std::vector<PhotographedLight>& a, const std::vector<PhotographedLight>& b) {
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto& first = a[i].white.light;
    const auto& second = b[i].white.light;
    for (int y = 1; y + 1 < first.height(); ++y) {
      for (int x = 1; x + 1 < first.width(); ++x) {
        const double ratio = first.at(x, y, 1) / second.at(x, y, 1);
        sum += ratio;
        squares += ratio * ratio;
        ++count;
      }
    }
  }
  return std::sqrt(squares / count - sum * sum / (count * count)) / (sum / count);
}

TEST_F(ResponseAccuracy, PhotographsOfWhiteAreLinearThroughAnyCamera) {
  rig_.projectors[1].lumens *= 0.7;
  SimulatedWall linear(rig_);
  const auto truth = whiteSeen(linear, linearCamera());
  rig_.camera.gamma = 2.2;
  SimulatedWall coded(rig_);
  const auto camera = measure(coded, 0).camera;
  ASSERT_TRUE(camera);
  const double before = differenceOf(whiteSeen(coded, linearCamera()), truth);
  const double after = differenceOf(whiteSeen(coded, *camera), truth);
  std::printf("light of white through a camera of gamma 2.2: %.1f %% off as it is, %.2f %% linearised\n", 100 * before,
              100 * after);
  EXPECT_GT(before, 0.05);
  EXPECT_LT(after, 0.01);
}

TEST_F(ResponseAccuracy, WithinOnePercentAndAHalfOfTheTruth) {
  for (const double cameraGamma : {1.0, 2.2}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      rig_.camera.gamma = cameraGamma;
      drawResponses(rig_, seed);
      SimulatedWall room(rig_);
      const std::size_t i = seed % 2;
      const auto found = measure(room, i);
      ASSERT_EQ(found.responses.size(), 1U);
      const auto& response = found.responses.at(rig_.projectors[i].name);
      const double error = responseError(response.curve, room, i);
      const double black = rig_.projectors[i].response.black;
      const double leak = black / (1 - black);
      std::printf("camera gamma %.1f, seed %u, %s: %.2f %% RMS (told %.2f %%), leak %.3f %% of %.3f %%\n", cameraGamma,
                  seed, rig_.projectors[i].name.c_str(), 100 * error, 100 * response.error,
                  100 * response.leak.value_or(0), 100 * leak);
      EXPECT_LT(error, 0.015);
      EXPECT_LT(error, 3 * response.error + 0.002) << "the error told is too small";
      EXPECT_LT(response.error, 0.015);
      EXPECT_NEAR(response.leak.value_or(0), leak, 0.04 * leak);
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
