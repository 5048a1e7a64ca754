#include <gmock/gmock.h>

#include "calib/simulate/rig.h"
#include "calib/simulate/rig_generator.h"
#include "calib/store/store.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// Rigs that a person would not aim like this on purpose.
class LayoutTest : public ::testing::Test {
 protected:
  Output calibrate(const calib::Rig& rig) {
    writeText(folder_ / "rig.yaml", calib::formatRig(rig));
    const Output made = runProgram("new", {wall().string(), "--rig", (folder_ / "rig.yaml").string()});
    EXPECT_EQ(made.status, 0) << made.text;
    return runProgram("calibrate", {wall().string()});
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  const TemporaryFolder folder_;
};

calib::Rig threeInARow() {
  return calib::casualRig(3, 1, {640, 480}, 4, {1200, 600});
}

TEST_F(LayoutTest, AProjectorThatIsOffIsLeftOutAndNamed) {
  calib::Rig rig = threeInARow();
  rig.projectors[1].lumens = 1;
  const Output run = calibrate(rig);
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("projector p2: p2/white.png: no brighter than black"));
  EXPECT_THAT(run.text, HasSubstr("is the projector on"));
  const auto calibration = calib::loadCalibration(wall());
  EXPECT_EQ(calibration.projectors.size(), 2u);
  EXPECT_EQ(calibration.find("p2"), nullptr);
}

TEST_F(LayoutTest, AProjectorThatTheRigDoesNotHaveIsLeftOut) {
  const calib::Rig rig = threeInARow();
  ASSERT_EQ(calibrate(rig).status, 0);
  calib::Rig fewer = rig;
  fewer.projectors.pop_back();
  writeText(wall() / "rig.yaml", calib::formatRig(fewer));
  const Output run = runProgram("calibrate", {wall().string()});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("projector p3: nothing was photographed of it"));
  EXPECT_EQ(calib::loadCalibration(wall()).projectors.size(), 2u);
}

TEST_F(LayoutTest, AProjectorOutsideAllOthersIsCalibratedAndCalledSo) {
  calib::Rig rig = threeInARow();
  rig.projectors[2].pose.rotation.x += 9;  // away from its neighbour
  rig.projectors[1].pose.rotation.x -= 4;
  const Output run = calibrate(rig);
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(calib::loadCalibration(wall()).projectors.size(), 3u) << run.text;
  EXPECT_THAT(run.text, HasSubstr("outside the display: shows nothing of the desktop"));
}

TEST_F(LayoutTest, NoOverlapAtAllStillCalibratesWhatThereIs) {
  calib::Rig rig = calib::miniRig(2);
  rig.projectors[0].pose.rotation.x -= 7;
  rig.projectors[1].pose.rotation.x += 7;
  const Output run = calibrate(rig);
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(calib::loadCalibration(wall()).projectors.size(), 2u) << run.text;
  EXPECT_THAT(run.text, ::testing::AnyOf(HasSubstr("overlaps no other projector"), HasSubstr("outside the display")));
}

}  // namespace
}  // namespace pixelflex::testing
