#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/procedure/verdicts.h"
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

}  // namespace
}  // namespace pixelflex::calib
