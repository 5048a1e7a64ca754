// The responses that the camera measures, against those that the simulated projectors have.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "calib/capture/live_photographs.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/response_step.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"

namespace pixelflex::calib {
namespace {

constexpr double kFloor = 0.01;  // of white: below it the error is relative to this

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

/// Relative to light, RMS over codes 20 to 235 and the channels.
double errorOf(const ResponseCurve& curve, const SimulatedWall& room, std::size_t index) {
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    const double black = room.light(index, c, 0);
    const double white = room.light(index, c, 1) - black;
    for (std::size_t code = 20; code <= 235; ++code) {
      const double truth = (room.light(index, c, static_cast<double>(code) / 255) - black) / white;
      const double found = curve.light[static_cast<std::size_t>(c)].at(code);
      squares += std::pow((found - truth) / std::max(truth, kFloor), 2);
    }
  }
  return std::sqrt(squares / (3 * 216));
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

  [[nodiscard]] ResponseResult measure(SimulatedWall& room) {
    std::vector<devices::Projector*> projectors;
    for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
    LivePhotographs photographs(room.camera(), projectors, room.person(), {}, "test", 0);
    return measureResponses(wall_, calibration_, {}, photographs, progress_,
                            [](const std::string&, const std::string& problem) { throw ProcedureError(problem); });
  }

  testing::TemporaryFolder folder_;
  Rig rig_ = casualRig(2, 1, {320, 240}, 3, {640, 360});
  Wall wall_;
  Calibration calibration_;
  RecordedProgress progress_;
};

TEST_F(ResponseAccuracy, WithinOnePercentAndAHalfOfTheTruth) {
  for (const double cameraGamma : {1.0, 2.2}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      rig_.camera.gamma = cameraGamma;
      drawResponses(rig_, seed);
      SimulatedWall room(rig_);
      const auto found = measure(room);
      ASSERT_EQ(found.responses.size(), room.projectorCount());
      for (std::size_t i = 0; i < room.projectorCount(); ++i) {
        const auto& response = found.responses.at(rig_.projectors[i].name);
        const double error = errorOf(response.curve, room, i);
        std::printf("camera gamma %.1f, seed %u, %s: %.2f %% RMS (told %.2f %%)", cameraGamma, seed,
                    rig_.projectors[i].name.c_str(), 100 * error, 100 * response.error);
        if (response.leak) {
          std::printf(", leak %.3f %% of %.3f %%", 100 * *response.leak,
                      100 * rig_.projectors[i].response.black / (1 - rig_.projectors[i].response.black));
        }
        std::printf("\n");
        EXPECT_LT(error, 0.015);
        EXPECT_LT(error, 3 * response.error + 0.002) << "the error told is too small";
        EXPECT_LT(response.error, 0.015);
      }
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
