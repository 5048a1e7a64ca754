#include <gmock/gmock.h>

#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "tests/e2e/mini_wall.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// A calibrated wall of two projectors, the second of which is then knocked.
class RepairTest : public ::testing::Test {
 protected:
  void SetUp() override { makeMiniWall(wall()); }
  Output calibrate(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), wall().string());
    return runProgram("calibrate", std::move(arguments));
  }
  void knock(double degrees) const {
    calib::Rig rig = calib::loadRig(wall() / "rig.yaml");
    rig.projectors[1].pose.rotation.x += degrees;
    writeText(wall() / "rig.yaml", calib::formatRig(rig));
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  const TemporaryFolder folder_;
};

TEST_F(RepairTest, CheckMeasuresTheDriftAndChangesNothing) {
  const calib::SimulatedWall before(calib::loadRig(wall() / "rig.yaml"));
  const std::string stored = textOf(wall() / "calibration.yaml");
  const auto photograph = fs::last_write_time(wall() / "captures/p1/blobs.png");
  const Output still = calibrate({"--check"});
  EXPECT_EQ(still.status, 0) << still.text;
  EXPECT_THAT(still.text, Not(HasSubstr("has moved")));

  knock(0.15);
  const calib::SimulatedWall after(calib::loadRig(wall() / "rig.yaml"));
  const Output run = calibrate({"--check"});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("has moved; run pixelflex calibrate WALL --only p2"));
  // The shift printed is the true one, at the frame's middle.
  const glm::dvec2 middle{320, 240};
  const glm::dvec2 moved = *before.projectorFromWall(1, *after.wallFromProjector(1, middle)) - middle;
  const auto line = run.text.substr(run.text.find("\np2"));
  double x = 0;
  double y = 0;
  std::istringstream words(line);
  std::string name, blobs;
  words >> name >> blobs >> x >> y;
  EXPECT_EQ(blobs, "100/100");
  EXPECT_NEAR(x, moved.x, 0.15);
  EXPECT_NEAR(y, moved.y, 0.15);

  EXPECT_TRUE(textOf(wall() / "calibration.yaml") == stored);
  EXPECT_EQ(fs::last_write_time(wall() / "captures/p1/blobs.png"), photograph);
}

TEST_F(RepairTest, OnlyMeasuresOneProjectorAgainstTheRest) {
  const auto before = calib::loadCalibration(wall());
  knock(0.3);
  const Output run = calibrate({"--only", "p2"});
  ASSERT_EQ(run.status, 0) << run.text;
  const auto after = calib::loadCalibration(wall());
  ASSERT_EQ(after.projectors.size(), 2u);
  EXPECT_TRUE(after.projectors[0].samples == before.projectors[0].samples);
  EXPECT_FALSE(after.projectors[1].samples == before.projectors[1].samples);
  EXPECT_EQ(after.camera, before.camera);
  EXPECT_EQ(after.display->resolution, before.display->resolution) << "the desktop keeps its size";
  // Right against the truth, and in place again.
  const calib::SimulatedWall room(calib::loadRig(wall() / "rig.yaml"));
  for (const auto& sample : after.projectors[1].samples) {
    const glm::dvec2 truth = *room.wallFromProjector(1, sample.pointInProjector);
    EXPECT_NEAR(sample.pointInWall.x, truth.x, 1);  // millimetres; a pixel is two
    EXPECT_NEAR(sample.pointInWall.y, truth.y, 1);
  }
  EXPECT_THAT(calibrate({"--check"}).text, Not(HasSubstr("has moved")));
  EXPECT_THAT(calibrate({}).text, HasSubstr("nothing has changed"));
}

TEST_F(RepairTest, OnlyRefusesAnUnknownProjectorAndAWallNeverCalibrated) {
  const Output unknown = calibrate({"--only", "p7"});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.text, HasSubstr("p7"));
  fs::remove(wall() / "calibration.yaml");
  const Output never = calibrate({"--only", "p2"});
  EXPECT_EQ(never.status, 1);
  EXPECT_THAT(never.text, HasSubstr("run pixelflex calibrate WALL first"));
}

TEST_F(RepairTest, ANudgeSurvivesRecalibrationUntilCleared) {
  const Output nudged = calibrate({"--nudge", "p1:x=3,y=-2,roll=0.1,tl=1/0"});
  ASSERT_EQ(nudged.status, 0) << nudged.text;
  const auto nudge = calib::loadCalibration(wall()).projectors[0].nudge;
  ASSERT_TRUE(nudge);
  EXPECT_EQ(nudge->shift, (glm::dvec2{3, -2}));
  EXPECT_EQ(nudge->corners[0], (glm::dvec2{1, 0}));
  ASSERT_EQ(calibrate({"--all"}).status, 0);
  EXPECT_EQ(calib::loadCalibration(wall()).projectors[0].nudge, nudge);
  ASSERT_EQ(calibrate({"--clear-nudge", "p1"}).status, 0);
  EXPECT_FALSE(calib::loadCalibration(wall()).projectors[0].nudge);
  EXPECT_FALSE(fs::exists(wall() / "nudge.yaml"));
}

// The viewer, which needs the pictures, sends people here.
TEST_F(RepairTest, PicturesThatAreGoneOrDamagedAreMadeAgain) {
  fs::remove(wall() / "calibration/p1-gain.png");
  fs::resize_file(wall() / "calibration/p2-alpha.png", 100);
  EXPECT_EQ(runProgram("check", {wall().string()}).status, 1);
  const Output run = calibrate({});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, ::testing::Not(HasSubstr("nothing has changed")));
  EXPECT_EQ(runProgram("check", {wall().string()}).status, 0);
}

TEST_F(RepairTest, ADamagedCalibrationIsMeasuredAnew) {
  fs::resize_file(wall() / "calibration.yaml", 300);
  const Output run = calibrate({});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("--all measures the wall anew"));
  EXPECT_EQ(calibrate({"--all"}).status, 0);
  EXPECT_EQ(runProgram("check", {wall().string()}).status, 0);
}

TEST_F(RepairTest, ANudgeThatIsNoneIsRefused) {
  for (const auto* text : {"p1", "p1:x", "p1:z=3", "p1:x=abc", "p1:tl=3", "p9:x=1"}) {
    const Output run = calibrate({"--nudge", text});
    EXPECT_EQ(run.status, 1) << text;
    EXPECT_FALSE(fs::exists(wall() / "nudge.yaml")) << text;
  }
  EXPECT_THAT(calibrate({"--nudge", "p1:tl=1500/900"}).text, HasSubstr("convex"));
}

}  // namespace
}  // namespace pixelflex::testing
