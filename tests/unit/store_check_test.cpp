#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string readings(int rows) {
  std::string text = "value,red,green,blue\n";
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + ",0.5, 1e-3,2\r\n";
  return text;
}

/// A wall's folder in good order: the example's wall with readings, one calibrated projector with mask and response.
class StoreCheck : public ::testing::Test {
 protected:
  StoreCheck() {
    saveWall(folder(), wall_);
    calibration_ = calib::flatCalibration(flatWall(1, 1));
    auto& projector = calibration_.projectors[0];
    projector.name = "p1";
    projector.flatAt.reset();
    projector.alpha = "calibration/p1-alpha.png";
    projector.response = "calibration/p1-response.csv";
    saveCalibration(folder(), calibration_);
    write("readings/p1.csv", readings(256));
    write("calibration/p1-response.csv", readings(256));
    devices::writePng(folder() / "calibration/p1-alpha.png", devices::Image16({1024, 768}, 1));
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return temporary_.path(); }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder() / name).parent_path());
    std::ofstream(folder() / name, std::ios::binary) << text;
  }
  /// The problems, file names relative to the folder.
  [[nodiscard]] std::vector<std::string> problems() const {
    std::vector<std::string> texts;
    for (const auto& problem : calib::checkWall(folder())) {
      std::string text = problem.text();
      const std::string prefix = folder().string() + "/";
      for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      texts.push_back(text);
    }
    return texts;
  }

  calib::Wall wall_ = exampleWall();
  calib::Calibration calibration_;

 private:
  TemporaryFolder temporary_;
};

TEST_F(StoreCheck, AWallInGoodOrderHasNoProblems) {
  EXPECT_THAT(problems(), IsEmpty());
}

TEST_F(StoreCheck, AnUncalibratedWallHasNoProblems) {
  std::filesystem::remove(folder() / "calibration.yaml");
  EXPECT_THAT(problems(), IsEmpty());
}

TEST_F(StoreCheck, MissingFilesAreReportedWhereTheyAreNamed) {
  for (const auto* name : {"readings/p1.csv", "calibration/p1-response.csv", "calibration/p1-alpha.png"}) {
    std::filesystem::remove(folder() / name);
  }
  EXPECT_THAT(problems(), ElementsAre("wall.yaml:19:12: gamma: there is no file readings/p1.csv",
                                      HasSubstr("alpha: there is no file calibration/p1-alpha.png"),
                                      HasSubstr("response: there is no file calibration/p1-response.csv")));
}

TEST_F(StoreCheck, GammaFromTheCameraNeedsNoFileButACamera) {
  std::filesystem::remove(folder() / "readings/p1.csv");
  wall_.projectors[0].gamma.reset();
  wall_.projectors[0].gammaByCamera = true;
  calib::saveWall(folder(), wall_);
  EXPECT_THAT(problems(), IsEmpty());
  wall_.camera.source = "none";
  calib::saveWall(folder(), wall_);
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("gamma: camera needs a camera")));
}

TEST_F(StoreCheck, TheCamerasResponseIsCheckedToo) {
  calibration_.camera = calib::CameraIntrinsics{{640, 480}, 500, 500, 320, 240, {}, {}, 0.1, 15};
  calibration_.camera->response = "calibration/camera-response.csv";
  calib::saveCalibration(folder(), calibration_);
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("response: there is no file calibration/camera-response.csv")));
  write("calibration/camera-response.csv", readings(255));
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("expected 256 readings, found 255")));
}

TEST_F(StoreCheck, ReadingsAreCheckedRowByRow) {
  std::string text = readings(256);
  text.replace(text.find("\n3,0.5") + 1, 5, "3,-1");
  text.replace(text.find("\n7,0.5") + 1, 5, "7,nan");
  text.replace(text.find("\n9,0.5") + 1, 5, "8,0.5");
  text.replace(text.find("\n11,0.5") + 1, 6, "11");
  write("readings/p1.csv", text);
  EXPECT_THAT(problems(), ElementsAre("readings/p1.csv:5: light cannot be negative: \"-1\"",
                                      "readings/p1.csv:9: expected a number, found \"nan\"",
                                      "readings/p1.csv:11: expected the reading of value 9, found \"8\"",
                                      "readings/p1.csv:13: expected four columns value,red,green,blue, found 3"));
}

TEST_F(StoreCheck, ReadingsAreCounted) {
  write("readings/p1.csv", readings(255));
  EXPECT_THAT(problems(), ElementsAre("readings/p1.csv: expected 256 readings, found 255"));
  write("readings/p1.csv", readings(256) + "256,1,1,1\n");
  EXPECT_THAT(problems(), ElementsAre("readings/p1.csv:258: more than 256 readings"));
  write("readings/p1.csv", "");
  EXPECT_THAT(problems(), ElementsAre("readings/p1.csv: expected 256 readings, found 0"));
}

TEST_F(StoreCheck, ReadingsNeedNoHeader) {
  write("readings/p1.csv", readings(256).substr(std::string("value,red,green,blue\n").size()));
  EXPECT_THAT(problems(), IsEmpty());
}

TEST_F(StoreCheck, AMaskOfAnotherSizeIsRefused) {
  devices::writePng(folder() / "calibration/p1-alpha.png", devices::Image16({1024, 767}, 1));
  EXPECT_THAT(problems(), ElementsAre("calibration/p1-alpha.png: the mask is 1024x767, its projector 1024x768"));
}

TEST_F(StoreCheck, AMaskOfEightBitsOrColourIsRefused) {
  devices::writePng(folder() / "calibration/p1-alpha.png", devices::Image8({1024, 768}, 1));
  EXPECT_THAT(problems(), ElementsAre("calibration/p1-alpha.png: a mask is a 16-bit grey PNG"));
  devices::writePng(folder() / "calibration/p1-alpha.png", devices::Image16({1024, 768}, 3));
  EXPECT_THAT(problems(), ElementsAre("calibration/p1-alpha.png: a mask is a 16-bit grey PNG"));
}

TEST_F(StoreCheck, ATruncatedMaskIsRefused) {
  const auto path = folder() / "calibration/p1-alpha.png";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("calibration/p1-alpha.png: ")));
}

TEST_F(StoreCheck, CalibrationAndWallMustBelongTogether) {
  wall_.projectors[0].resolution = {1920, 1080};
  wall_.projectors.push_back(wall_.projectors[0]);
  wall_.projectors.back().name = "p2";
  saveWall(folder(), wall_);
  auto second = calibration_.projectors[0];
  second.name = "p3";
  calibration_.projectors.push_back(second);
  saveCalibration(folder(), calibration_);
  EXPECT_THAT(problems(), ElementsAre("calibration.yaml:9:17: resolution: wall.yaml says 1920x1080: run pixelflex "
                                      "calibrate WALL again",
                                      HasSubstr("name: wall.yaml has no projector p3"),
                                      HasSubstr("projector p2 is not calibrated: run pixelflex calibrate WALL")));
}

TEST_F(StoreCheck, ProblemsOfSeveralFilesAreListedTogether) {
  write("wall.yaml", dataFile("wall-v1.yaml") + "extra: 1\n");
  write("calibration.yaml", dataFile("calibration-v1.yaml") + "version: 3\n");
  EXPECT_THAT(problems(), ElementsAre("wall.yaml:27:1: unknown key \"extra\"",
                                      "calibration.yaml:49:1: the key \"version\" is given twice"));
}

TEST_F(StoreCheck, AnEmptyFolderSaysThatThereIsNoWall) {
  const TemporaryFolder empty;
  const auto found = calib::checkWall(empty.path());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace pixelflex::testing
