#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calib/capture/live_photographs.h"
#include "calib/procedure/white_photographs.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"

namespace pixelflex::calib {
namespace {

/// Mean and deviation of a logarithm: a common factor does not count.
struct Spread {
  double sum = 0, squares = 0, count = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / count - sum / count * sum / count); }
};

/// What the simulated camera and the estimators make of every projector's white, against what the simulator knows.
double errorOfMeasuredWhite(const Rig& rig) {
  SimulatedWall room(rig);
  const testing::TemporaryFolder folder;
  const auto [wall, calibration, warnings] = calibrateRig(room, folder.path());
  std::vector<devices::Projector*> projectors;
  for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
  LivePhotographs photographs(room.camera(), projectors, room.person(), {}, "test", 0, room.placeCount());
  RecordedProgress progress;
  const auto fields = withoutVignetting(
      calibration, photographLight(calibration, linearCamera(), Method::kBlobs, 48, photographs, progress));
  Spread spread;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const devices::Size frame = calibration.projectors[i].resolution;
    for (int y = 0; y < fields[i].height(); ++y) {
      for (int x = 0; x < fields[i].width(); ++x) {
        const glm::dvec2 p((x + 0.5) / fields[i].width() * frame.width, (y + 0.5) / fields[i].height() * frame.height);
        const double truth = room.radiance(i, p) * room.light(i, 1, 1.0);
        if (fields[i].at(x, y, 1) > 0) spread.add(std::log(fields[i].at(x, y, 1) / truth));
      }
    }
  }
  return spread.deviation();
}

TEST(MeasuredLight, OfThreeProjectors) {
  const double error = errorOfMeasuredWhite(casualRig(3, 1, {640, 480}, 4, {1280, 720}));
  std::printf("measured white against truth: %.2f %% rms\n", 100 * error);
  EXPECT_LT(error, 0.005);
}

TEST(MeasuredLight, OfAnInsetAlone) {
  // Two frames about the same middle leave the camera's loss nearly open, and the wide one is nine times dimmer.
  const double error = errorOfMeasuredWhite(insetRig(1));
  std::printf("measured white against truth: %.2f %% rms\n", 100 * error);
  EXPECT_LT(error, 0.006);
}

}  // namespace
}  // namespace pixelflex::calib
