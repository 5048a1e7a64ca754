#include <gmock/gmock.h>

#include <iostream>

#include "calib/simulate/rig.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/coordinate_desktop.h"
#include "tests/support_calibration/registration.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex {
namespace {

using calib::RegistrationFigures;
using calib::SimulatedWall;

RegistrationFigures measure(SimulatedWall& room) {
  const testing::TemporaryFolder folder;
  const auto calibrated = calib::calibrateRig(room, folder.path());
  EXPECT_THAT(calibrated.warnings, ::testing::IsEmpty());
  EXPECT_EQ(calibrated.calibration.projectors.size(), room.projectorCount());
  const viewer::WallPlan wall(folder.path(), calibrated.wall, calibrated.calibration, {});
  const auto shown = calib::showCoordinates(room.rig(), wall);
  auto figures = calib::measureRegistration(room, calib::meantByPictures(*calibrated.calibration.display, shown));
  for (std::size_t i = 0; i < figures.registration.size(); ++i) {
    std::cout << room.rig().projectors[i].name << "  registration " << calib::text(figures.registration[i]) << "\n";
  }
  std::cout << "all registration " << calib::text(figures.all) << "\nseam " << calib::text(figures.seam) << "\n";
  return figures;
}

// The whole path against ground truth: camera, structured light, smooth model, mesh, GPU.
TEST(Registration, OfTheReportRigIsFarBelowAPixel) {
  SimulatedWall room(calib::loadRig(PIXELFLEX_SOURCE_DIR "/config/rigs/report-8.yaml"));
  const auto figures = measure(room);
  EXPECT_GT(figures.seam.count, 100'000u);
  EXPECT_LE(figures.seam.rms, 0.15);
  EXPECT_LE(figures.seam.maximum, 0.6);
  EXPECT_LE(figures.all.rms, 0.15);
  EXPECT_LE(figures.all.maximum, 0.6);
  for (const auto& projector : figures.registration) EXPECT_GT(projector.count, 50'000u);
}

TEST(Registration, OfTheMiniRigHolds) {
  SimulatedWall room(calib::loadRig(PIXELFLEX_SOURCE_DIR "/config/rigs/mini-2.yaml"));
  const auto figures = measure(room);
  EXPECT_LE(figures.seam.rms, 0.15);
  EXPECT_LE(figures.seam.maximum, 0.6);
}

}  // namespace
}  // namespace pixelflex
