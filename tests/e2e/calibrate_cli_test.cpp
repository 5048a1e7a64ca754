#include <gmock/gmock.h>

#include "calib/store/store.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class CalibrateTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Output made = runProgram("new", {wall(), "--rig", kMiniRig});
    ASSERT_EQ(made.status, 0) << made.text;
  }
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }
  [[nodiscard]] Output calibrate(std::vector<std::string> arguments = {}) const {
    arguments.insert(arguments.begin(), wall());
    return runProgram("calibrate", std::move(arguments));
  }
  const TemporaryFolder folder_;
};

TEST_F(CalibrateTest, MeasuresTheWallThroughTheLiveCamera) {
  const Output run = calibrate();
  ASSERT_EQ(run.status, 0) << run.text;
  for (const auto* word :
       {"camera", "surface", "projectors", "mesh", "blend", "gamma", "p1", "p2", "100/100", "desktop", "report.html"}) {
    EXPECT_THAT(run.text, HasSubstr(word));
  }
  const auto calibration = calib::loadCalibration(wall());
  ASSERT_EQ(calibration.projectors.size(), 2u);
  ASSERT_TRUE(calibration.camera && calibration.surface && calibration.display);
  EXPECT_LT(calibration.camera->rmsPx, 0.2);
  for (const auto& projector : calibration.projectors) {
    EXPECT_EQ(projector.samples.size(), 100u);
    EXPECT_LT(projector.quality.rms, 0.1);
    EXPECT_TRUE(fs::exists(fs::path(wall()) / *projector.alpha));
    EXPECT_TRUE(fs::exists(fs::path(wall()) / *projector.response));
  }
  EXPECT_THAT(textOf(fs::path(wall()) / "report.html"), HasSubstr("<svg"));
  EXPECT_TRUE(calib::checkWall(wall()).empty());
  EXPECT_TRUE(fs::exists(fs::path(wall()) / "captures/p2/bit6.png"));

  // Once more: nothing is stale.
  const Output again = calibrate();
  EXPECT_EQ(again.status, 0) << again.text;
  EXPECT_THAT(again.text, HasSubstr("nothing has changed"));
  EXPECT_TRUE(calib::loadCalibration(wall()) == calibration);
}

TEST_F(CalibrateTest, RunsOnlyWhatAChangeMadeStale) {
  ASSERT_EQ(calibrate().status, 0);
  const fs::path file = fs::path(wall()) / "wall.yaml";
  const std::string before = textOf(file);
  const std::string after = replaced(before, "margin: 24", "margin: 60");
  ASSERT_NE(before, after);
  writeText(file, after);
  const auto old = calib::loadCalibration(wall());
  const Output run = calibrate();
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("mesh "));
  EXPECT_THAT(run.text, ::testing::Not(HasSubstr("projectors 2")));
  const auto now = calib::loadCalibration(wall());
  EXPECT_TRUE(now.projectors[0].samples == old.projectors[0].samples);
  EXPECT_LT(now.display->resolution.area(), old.display->resolution.area());
}

TEST_F(CalibrateTest, RepeatsASolveFromItsOwnCaptures) {
  ASSERT_EQ(calibrate().status, 0);
  const auto live = calib::loadCalibration(wall());
  const Output run = calibrate({"--photos", wall() + "/captures"});
  ASSERT_EQ(run.status, 0) << run.text;
  const auto offline = calib::loadCalibration(wall());
  // The same but for the order in which two threads add up.
  EXPECT_NEAR(offline.camera->fx, live.camera->fx, 1e-6);
  EXPECT_EQ(offline.display->resolution, live.display->resolution);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& a = offline.projectors[i].samples;
    const auto& b = live.projectors[i].samples;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].pointInProjector, b[k].pointInProjector);
      EXPECT_NEAR(a[k].pointInWall.x, b[k].pointInWall.x, 1e-4);
      EXPECT_NEAR(a[k].pointInWall.y, b[k].pointInWall.y, 1e-4);
    }
  }
}

TEST_F(CalibrateTest, RunsSingleStepsInOrderAndSaysWhatIsMissing) {
  const Output early = calibrate({"mesh"});
  EXPECT_EQ(early.status, 1);
  EXPECT_THAT(early.text, HasSubstr("step mesh needs projectors first"));
  EXPECT_FALSE(fs::exists(fs::path(wall()) / "calibration.yaml"));
  EXPECT_EQ(calibrate({"camera", "surface"}).status, 0);
  const auto half = calib::loadCalibration(wall());
  EXPECT_TRUE(half.camera && half.surface);
  EXPECT_TRUE(half.projectors.empty());
}

TEST_F(CalibrateTest, RefusesAnUnknownStepAsWrongUsage) {
  const Output run = calibrate({"meshes"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.text, HasSubstr("meshes"));
}

TEST_F(CalibrateTest, NamesFileAndLineOfABadWall) {
  writeText(fs::path(wall()) / "wall.yaml", "format: pixelflex-wall\nversion: 1\nsurface: {shape: round}\n");
  const Output run = calibrate();
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("wall.yaml:3:"));
}

TEST_F(CalibrateTest, SaysWhenThereIsNoWall) {
  const Output run = runProgram("calibrate", {(folder_ / "nowhere").string()});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("nowhere"));
}

TEST_F(CalibrateTest, NeedsNoCameraForAFlatWall) {
  const std::string flat = (folder_ / "flat").string();
  ASSERT_EQ(runProgram("new", {flat, "--flat", "2x1:800x600"}).status, 0);
  fs::remove(fs::path(flat) / "calibration.yaml");
  const Output run = runProgram("calibrate", {flat});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(calib::loadCalibration(flat).display->resolution, (devices::Size{1600, 600}));
}

}  // namespace
}  // namespace pixelflex::testing
