#include <gmock/gmock.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>

#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

void shrink(calib::Optics& optics, devices::Size& size, int factor) {
  optics.focal /= factor;
  optics.principal = optics.principal / double(factor);
  size = {size.width / factor, size.height / factor};
}

/// The same rig with fewer pixels, so that photographs are quickly taken.
calib::Rig coarse(calib::Rig rig, int projectorFactor, int cameraFactor) {
  for (auto& projector : rig.projectors) shrink(projector.optics, projector.resolution, projectorFactor);
  shrink(rig.camera.optics, rig.camera.size, cameraFactor);
  return rig;
}

/// A calibrated wall in a folder of its own, its photographs in captures/.
struct CalibratedWall {
  CalibratedWall(const calib::Rig& rig, const std::vector<std::string>& options) {
    writeText(folder / "rig.yaml", calib::formatRig(rig));
    made = runProgram("new", {wall().string(), "--rig", (folder / "rig.yaml").string()});
    std::vector<std::string> arguments = {wall().string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    calibrated = runProgram("calibrate", std::move(arguments));
  }
  [[nodiscard]] fs::path wall() const { return folder / "wall"; }
  /// A copy of the wall.yaml alone, with one text replaced, that knows no photographs yet.
  [[nodiscard]] fs::path variant(const std::string& name, const std::string& from, const std::string& to) const {
    const std::string text = replaced(textOf(wall() / "wall.yaml"), from, to);
    EXPECT_NE(text, textOf(wall() / "wall.yaml"));
    writeText(folder / name / "wall.yaml", text);
    fs::copy_file(wall() / "rig.yaml", folder / name / "rig.yaml");
    fs::copy(wall() / "readings", folder / name / "readings");
    return folder / name;
  }
  TemporaryFolder folder;
  Output made, calibrated;
};

/// Largest error of the stored models against the simulated optics over all frames, in projector pixels.
double worstError(const fs::path& wall, const calib::SimulatedWall& truth) {
  const auto calibration = calib::loadCalibration(wall);
  double worst = calibration.projectors.size() == truth.projectorCount() ? 0 : 1e9;
  for (std::size_t i = 0; i < calibration.projectors.size(); ++i) {
    const calib::ProjectorMapping mapping(calibration.projectors[i]);
    const devices::Size size = calibration.projectors[i].resolution;
    for (int k = 0; k < 81; ++k) {
      const glm::dvec2 p(size.width * (k % 9) / 8.0, size.height * static_cast<int>(k / 9) / 8.0);
      const auto inWall = truth.wallFromProjector(i, p);
      const auto back = inWall ? mapping.projectorFromWall(*inWall) : std::nullopt;
      worst = std::max(worst, back ? glm::length(*back - p) : 1e9);
    }
  }
  return worst;
}

class CurvedTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    calib::Rig rig = coarse(calib::cylinderRig(2), 3, 2);
    rig.projectors.pop_back();
    rig.checkerboardPoses = 8;
    shared_ = std::make_unique<CalibratedWall>(rig, std::vector<std::string>{"--method", "dense"});
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static Output calibrate(const fs::path& wall, std::vector<std::string> options) {
    options.insert(options.begin(), wall.string());
    return runProgram("calibrate", std::move(options));
  }
  static std::string captures() { return (shared_->wall() / "captures").string(); }
  static inline std::unique_ptr<CalibratedWall> shared_;
};

TEST_F(CurvedTest, ACylinderIsUnrolled) {
  ASSERT_EQ(shared_->made.status, 0) << shared_->made.text;
  ASSERT_EQ(shared_->calibrated.status, 0) << shared_->calibrated.text;
  EXPECT_THAT(textOf(shared_->wall() / "wall.yaml"), HasSubstr("shape: {cylinder: {radius: 3000}}"));
  const calib::SimulatedWall truth(calib::loadRig(shared_->wall() / "rig.yaml"));
  EXPECT_LT(worstError(shared_->wall(), truth), 0.3);
}

TEST_F(CurvedTest, TheMethodIsRememberedAndSolvedAgainOffline) {
  const fs::path wall = shared_->variant("offline", "source: sim", "source: photos");
  const Output run = calibrate(wall, {"--photos", captures()});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(calib::loadCalibration(wall).projectors, calib::loadCalibration(shared_->wall()).projectors);
  const Output again = calibrate(wall, {});
  EXPECT_EQ(again.status, 0) << again.text;
  EXPECT_THAT(again.text, HasSubstr("nothing has changed"));
}

TEST_F(CurvedTest, APlaneIsRefusedWithTheMeasuredBow) {
  const fs::path wall = shared_->variant("plane", "shape: {cylinder: {radius: 3000}}\n", "shape: planar\n");
  const Output run = calibrate(wall, {"--photos", captures()});
  EXPECT_EQ(run.status, 1) << run.text;
  EXPECT_THAT(run.text, HasSubstr("the screen is not flat: it bows by about"));
  EXPECT_THAT(run.text, HasSubstr("a radius of about 30"));  // 3000, to two per cent
  EXPECT_FALSE(fs::exists(wall / "calibration.yaml"));
}

TEST_F(CurvedTest, APlaneThroughFourCornersIsRefusedByThePictures) {
  const fs::path wall = shared_->variant("corners", "shape: {cylinder: {radius: 3000}}\n", "shape: planar\n");
  std::string text = textOf(wall / "wall.yaml");
  const auto rig = calib::loadRig(shared_->wall() / "rig.yaml");
  const double middle = rig.screenSize.x / 2;
  const auto ends = [](const calib::SimulatedMarker& marker, double left, double right) {
    return marker.centre.x == left || marker.centre.x == right;
  };
  for (const bool upper : {true, false}) {
    std::vector<double> x;
    for (const auto& marker : rig.markers) {
      if ((marker.centre.y < rig.screenSize.y / 2) == upper) x.push_back(marker.centre.x);
    }
    const auto [left, right] = std::ranges::minmax(x);
    for (const auto& marker : rig.markers) {
      if ((marker.centre.y < rig.screenSize.y / 2) != upper) continue;
      const auto at = text.find("    - {aruco: " + std::to_string(marker.aruco) + ",");
      ASSERT_NE(at, std::string::npos);
      text.erase(at, text.find('\n', at) + 1 - at);
      if (!ends(marker, left, right)) continue;
      // Measured with a taut string, the corners lie on the plane through them.
      const double chord = 3000 * std::sin((marker.centre.x - middle) / 3000);
      text.insert(at, "    - {aruco: " + std::to_string(marker.aruco) + ", at: [" + std::to_string(chord) + ", " +
                          std::to_string(marker.centre.y) + "]}\n");
    }
  }
  writeText(wall / "wall.yaml", text);
  const Output run = calibrate(wall, {"--photos", captures()});
  EXPECT_EQ(run.status, 1) << run.text;
  EXPECT_THAT(run.text, ::testing::ContainsRegex("projector p[12]: the screen is not flat: it bows by about"));
  EXPECT_FALSE(fs::exists(wall / "calibration.yaml"));
}

TEST_F(CurvedTest, ShapeCameraIsRightFromTheCamera) {
  const fs::path wall = shared_->variant("camera", "shape: {cylinder: {radius: 3000}}\n", "shape: camera\n");
  const Output run = calibrate(wall, {"--photos", captures()});
  ASSERT_EQ(run.status, 0) << run.text;
  const auto calibration = calib::loadCalibration(wall);
  const calib::CameraMapping camera(calibration.camera.value());
  const calib::SimulatedWall truth(calib::loadRig(shared_->wall() / "rig.yaml"));
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < calibration.projectors.size(); ++i) {
    const calib::ProjectorMapping mapping(calibration.projectors[i]);
    const devices::Size size = calibration.projectors[i].resolution;
    for (int k = 0; k < 81; ++k) {
      const glm::dvec2 p(size.width * (k % 9) / 8.0, size.height * static_cast<int>(k / 9) / 8.0);
      const auto raw = truth.cameraFromWall(*truth.wallFromProjector(i, p));
      const auto back = mapping.projectorFromWall(camera.undistortedFromRaw(*raw));
      ASSERT_TRUE(back);
      squares += glm::dot(*back - p, *back - p);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.1);
}

TEST_F(CurvedTest, SeveralPlacesNeedAFlatWall) {
  const fs::path wall = shared_->variant("places", "source: sim", "source: photos");
  const Output run = calibrate(wall, {"--photos", captures(), "--photos", captures(), "--method", "dense"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("several camera places need a flat wall"));
}

/// Four projectors of the large wall, seen from two places.
calib::Rig wideRig() {
  calib::Rig rig = coarse(calib::largeRig(1), 2, 2);
  std::erase_if(rig.projectors, [](const auto& projector) {
    return projector.name != "p1" && projector.name != "p2" && projector.name != "p3" && projector.name != "p4";
  });
  rig.cameraPlaces.resize(1);
  rig.checkerboardPoses = 8;
  return rig;
}

TEST(PlacesCliTest, AWallThatOnePhotographCannotHold) {
  const CalibratedWall made(wideRig(), {});
  ASSERT_EQ(made.calibrated.status, 0) << made.calibrated.text;
  const calib::SimulatedWall truth(calib::loadRig(made.wall() / "rig.yaml"));
  constexpr double kWorst = 0.8;  // absolute: eleven markers on 960x540 pixels tie the two places to the wall
  EXPECT_LT(worstError(made.wall(), truth), kWorst);
  ASSERT_TRUE(fs::exists(made.wall() / "captures/place2"));

  // The same from two folders of photographs, given in order.
  const fs::path photos = made.wall() / "captures";
  fs::rename(photos / "checkerboard", photos / "place1" / "checkerboard");
  const fs::path offline = made.variant("offline", "source: sim", "source: photos");
  const Output run = runProgram("calibrate", {"--photos", (photos / "place1").string(), "--photos",
                                              (photos / "place2").string(), offline.string()});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_EQ(calib::loadCalibration(offline).projectors, calib::loadCalibration(made.wall()).projectors);

  const Output drift = runProgram("calibrate", {made.wall().string(), "--check"});
  EXPECT_EQ(drift.status, 0) << drift.text;
  EXPECT_THAT(drift.text, ::testing::Not(HasSubstr("moved")));
  const Output only = runProgram("calibrate", {made.wall().string(), "--only", "p2"});
  EXPECT_EQ(only.status, 0) << only.text;
  EXPECT_LT(worstError(made.wall(), truth), kWorst);
}

}  // namespace
}  // namespace pixelflex::testing
