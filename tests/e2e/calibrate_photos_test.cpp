#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "devices/image/photo_file.h"
#include "devices/image/png_file.h"
#include "tests/e2e/mini_wall.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A wall that was calibrated once, and its photographs to be spoiled; then the store must stay as it was.
class PhotosTest : public ::testing::Test {
 protected:
  void SetUp() override {
    makeMiniWall(wall());
    fs::copy(wall() / "captures", photos(), fs::copy_options::recursive);
    stored_ = textOf(wall() / "calibration.yaml");
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] fs::path photos() const { return folder_ / "photos"; }

  /// Calibrates from the photographs, which must fail with all of these words and change nothing.
  void expectRefused(const std::vector<std::string>& words) {
    const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
    EXPECT_EQ(run.status, 1);
    for (const auto& word : words) EXPECT_THAT(run.text, HasSubstr(word));
    EXPECT_TRUE(textOf(wall() / "calibration.yaml") == stored_) << "the store has changed";
  }

  const TemporaryFolder folder_;
  std::string stored_;
};

TEST_F(PhotosTest, AMissingPhotographIsNamed) {
  fs::remove(photos() / "p2/bit3.png");
  expectRefused({"p2/bit3.png", "missing"});
}

TEST_F(PhotosTest, ATruncatedPhotographIsNamed) {
  fs::resize_file(photos() / "p1/blobs.png", fs::file_size(photos() / "p1/blobs.png") / 2);
  expectRefused({"p1/blobs.png", "again"});
}

TEST_F(PhotosTest, ATextFileIsNoPhotograph) {
  writeText(photos() / "p1/white.png", "hello");
  expectRefused({"p1/white.png", "neither a PNG nor a JPEG"});
}

TEST_F(PhotosTest, BlackAndWhiteSwappedIsNoticed) {
  fs::rename(photos() / "p1/white.png", photos() / "p1/x.png");
  fs::rename(photos() / "p1/black.png", photos() / "p1/white.png");
  fs::rename(photos() / "p1/x.png", photos() / "p1/black.png");
  expectRefused({"p1", "swapped"});
}

TEST_F(PhotosTest, BlobsNotFoundGivesProjectorCountAndCause) {
  // The lens cap was on for this projector.
  for (const auto& photo : fs::directory_iterator(photos() / "p2")) {
    fs::copy_file(photos() / "p2/black.png", photo.path() == photos() / "p2/black.png" ? photos() / "x" : photo.path(),
                  fs::copy_options::overwrite_existing);
  }
  expectRefused({"projector p2", "p2/white.png", "no brighter than black"});
}

TEST_F(PhotosTest, AnOverExposedPhotographIsCalledSo) {
  for (const auto* name : {"white", "blobs", "bit0", "bit1", "bit2", "bit3", "bit4", "bit5", "bit6"}) {
    const fs::path file = photos() / "p1" / (std::string(name) + ".png");
    devices::Image8 photo = devices::readPhoto(file);
    for (auto& sample : photo.samples()) sample = static_cast<std::uint8_t>(std::min(255, sample * 12));
    devices::writePng(file, photo);
  }
  expectRefused({"projector p1", "p1/white.png", "over-exposed"});
}

TEST_F(PhotosTest, FewerThanFourFiducialsIsAnErrorThatCounts) {
  devices::Image8 photo = devices::readPhoto(photos() / "fiducials.png");
  for (int y = 0; y < photo.height(); ++y) {  // somebody stands before the right half
    for (int x = photo.width() * 2 / 5; x < photo.width(); ++x) {
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = 90;
    }
  }
  devices::writePng(photos() / "fiducials.png", photo);
  expectRefused({"fiducials.png", "fewer than four fiducials: 2 of 6", "markers not found"});
}

TEST_F(PhotosTest, FiducialsMayBePixelsInstead) {
  calib::Wall byHand = calib::loadWall(wall());
  // The same four corners of the wall as the simulated camera sees them, read off a photograph to half a pixel.
  const calib::SimulatedWall room(calib::loadRig(wall() / "rig.yaml"));
  for (auto& fiducial : byHand.surface.fiducials) {
    const glm::dvec2 seen = room.cameraFromWall(fiducial.pointInWall).value();
    fiducial.aruco.reset();
    fiducial.pointInCamera = glm::dvec2(std::round(seen.x), std::round(seen.y));
  }
  calib::saveWall(wall(), byHand);
  fs::remove(photos() / "fiducials.png");
  const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
  EXPECT_EQ(run.status, 0) << run.text;
  const auto calibration = calib::loadCalibration(wall());
  EXPECT_LT(calibration.surface->rms, 3);  // millimetres; a camera pixel is about 3 of them
  EXPECT_LT(calibration.projectors[0].quality.rms, 0.1);
}

TEST_F(PhotosTest, NoCheckerboardNeedsKnownIntrinsics) {
  fs::remove_all(photos() / "checkerboard");
  expectRefused({"no checkerboard photographs", (photos() / "checkerboard").string(), "camera.yaml"});
  const auto camera = calib::loadCalibration(wall()).camera.value();
  std::string yaml = "size: [960, 600]\nfx: " + std::to_string(camera.fx) + "\nfy: " + std::to_string(camera.fy) +
                     "\ncx: " + std::to_string(camera.cx) + "\ncy: " + std::to_string(camera.cy) + "\nradial: [";
  for (int i = 0; i < 3; ++i) yaml += (i > 0 ? ", " : "") + std::to_string(camera.radial[static_cast<std::size_t>(i)]);
  yaml +=
      "]\ntangential: [" + std::to_string(camera.tangential[0]) + ", " + std::to_string(camera.tangential[1]) + "]\n";
  writeText(photos() / "camera.yaml", yaml);
  const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("known intrinsics"));
}

TEST_F(PhotosTest, AProjectorWithoutPhotographsIsLeftOut) {
  fs::remove_all(photos() / "p2");
  const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("projector p2: nothing was photographed"));
  EXPECT_THAT(run.text, HasSubstr("not calibrated"));
  EXPECT_EQ(calib::loadCalibration(wall()).projectors.size(), 1u);
}

TEST_F(PhotosTest, PatternsAreWhatAPersonShows) {
  const fs::path patterns = folder_ / "patterns";
  const Output run = runProgram("calibrate", {wall().string(), "--patterns", patterns.string()});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(textOf(patterns / "README.txt"), HasSubstr("p2/bit6.png"));
  for (const auto* projector : {"p1", "p2"}) {
    for (const auto* name : {"black", "white", "blobs", "bit0", "bit6"}) {
      const auto image = devices::readPng8(patterns / projector / (std::string(name) + ".png"));
      EXPECT_EQ(image.size(), (devices::Size{640, 480}));
    }
  }
  EXPECT_EQ(std::ranges::max(devices::readPng8(patterns / "p1/black.png").samples()), 0);
  EXPECT_EQ(std::ranges::min(devices::readPng8(patterns / "p1/white.png").samples()), 255);
}

TEST_F(PhotosTest, AFolderThatIsNotThereIsSaidSo) {
  fs::remove_all(photos());
  expectRefused({"photos", "no such folder"});
}

}  // namespace
}  // namespace pixelflex::testing
