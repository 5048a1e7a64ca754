#include <gmock/gmock.h>

#include <algorithm>
#include <iostream>

#include "calib/simulate/rig.h"
#include "devices/display/gl_context.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/registration.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex {
namespace {

using calib::RegistrationFigures;
using calib::SimulatedWall;

/// What each projector of the rig, in the rig's order, shows of a desktop of its own coordinates; empty for those that
/// were not calibrated.
std::vector<devices::ImageF> showCoordinates(const SimulatedWall& room, const viewer::WallPlan& wall) {
  devices::HeadlessContext context;
  viewer::WallRenderer renderer(context, {.measure = true});
  renderer.setPlans(wall.outputsFor(wall.desktop()));
  devices::ImageF desktop(wall.desktop(), 4);
  for (int y = 0; y < desktop.height(); ++y) {
    for (int x = 0; x < desktop.width(); ++x) {
      desktop.at(x, y, 0) = static_cast<float>(x + 0.5);
      desktop.at(x, y, 1) = static_cast<float>(y + 0.5);
    }
  }
  renderer.uploadDesktop(desktop);
  renderer.draw();
  std::vector<devices::ImageF> shown(room.projectorCount());
  for (std::size_t output = 0; output < renderer.outputCount(); ++output) {
    for (std::size_t i = 0; i < room.projectorCount(); ++i) {
      if (room.rig().projectors[i].name == renderer.outputName(output)) shown[i] = renderer.readOutputFloat(output);
    }
  }
  return shown;
}

RegistrationFigures measure(SimulatedWall& room) {
  const testing::TemporaryFolder folder;
  const auto calibrated = calib::calibrateRig(room, folder.path());
  EXPECT_THAT(calibrated.warnings, ::testing::IsEmpty());
  EXPECT_EQ(calibrated.calibration.projectors.size(), room.projectorCount());
  const viewer::WallPlan wall(folder.path(), calibrated.wall, calibrated.calibration, {});
  auto figures = calib::measureRegistration(room, *calibrated.calibration.display, showCoordinates(room, wall));
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
