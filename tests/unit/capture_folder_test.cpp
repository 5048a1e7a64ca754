// Photographs from folders: places of the camera, what is kept, and what is told when something is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "calib/capture/exposure_name.h"
#include "calib/capture/folder_photographs.h"
#include "calib/patterns/response_pattern.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using pixelflex::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A picture of one colour, to be told from others by.
void writePhoto(const fs::path& file, int code) {
  devices::Image8 photo({4, 3}, 3);
  for (auto& sample : photo.samples()) sample = static_cast<std::uint8_t>(code);
  devices::writePng(file, photo);
}

int codeOf(const devices::Image8& photo) {
  return photo.at(0, 0);
}

ProjectedPattern named(const std::string& name) {
  return {name, "", {}};
}

int codeSeen(Photographs& photographs, const std::string& projector, const std::string& pattern) {
  return codeOf(photographs.pattern(projector, named(pattern)));
}

/// All files below a folder, relative and sorted.
std::vector<std::string> filesIn(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder).string());
  }
  std::ranges::sort(files);
  return files;
}

/// Asks for everything that is there, as a calibration does.
void useAll(Photographs& photographs, const std::vector<std::string>& projectors, const std::string& pattern) {
  while (photographs.nextCheckerboard()) {
  }
  for (int place = 0; place < photographs.placeCount(); ++place) {
    photographs.choosePlace(place);
    if (photographs.hasFiducials()) (void)photographs.fiducials();
    for (const auto& name : projectors) {
      if (photographs.hasProjector(name)) (void)photographs.pattern(name, named(pattern));
    }
  }
}

class CaptureTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path photos() const { return folder_ / "photos"; }
  [[nodiscard]] fs::path captures() const { return folder_ / "captures"; }
  FolderPhotographs open(const std::vector<fs::path>& folders) { return {folders, captures()}; }

  /// left sees p1 and p2, right p2 and p3 and no marker.
  void writeTwoPlaces() {
    writePhoto(photos() / "checkerboard/1.png", 1);
    writePhoto(photos() / "left/fiducials.png", 10);
    writePhoto(photos() / "left/p1/white.png", 11);
    writePhoto(photos() / "left/p2/white.png", 12);
    writePhoto(photos() / "right/p2/white.png", 22);
    writePhoto(photos() / "right/p3/white.png", 23);
  }
  void writeOnePlace(int code) {
    writePhoto(photos() / "checkerboard/1.png", code);
    writePhoto(photos() / "fiducials.png", code);
    writePhoto(photos() / "p1/white.png", code);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(CaptureTest, AFolderOfProjectorsIsOnePlace) {
  writeOnePlace(7);
  auto photographs = open({photos()});
  EXPECT_EQ(photographs.placeCount(), 1);
  EXPECT_EQ(photographs.checkerboardCount(), 1);
  EXPECT_TRUE(photographs.hasFiducials());
  EXPECT_TRUE(photographs.hasProjector("p1"));
  EXPECT_FALSE(photographs.hasProjector("p2"));
  EXPECT_EQ(codeSeen(photographs, "p1", "white"), 7);
}

TEST_F(CaptureTest, SubfoldersOfProjectorsArePlaces) {
  writeTwoPlaces();
  auto photographs = open({photos()});
  ASSERT_EQ(photographs.placeCount(), 2);
  EXPECT_EQ(photographs.checkerboardCount(), 1);
  EXPECT_TRUE(photographs.hasFiducials());
  EXPECT_FALSE(photographs.hasProjector("p3"));
  EXPECT_EQ(codeSeen(photographs, "p2", "white"), 12);
  photographs.choosePlace(1);
  EXPECT_FALSE(photographs.hasFiducials());
  EXPECT_FALSE(photographs.hasProjector("p1"));
  EXPECT_EQ(codeSeen(photographs, "p2", "white"), 22);
}

TEST_F(CaptureTest, PlacesGivenByNameKeepTheirOrderAndJoinTheirCheckerboards) {
  writeTwoPlaces();
  writePhoto(photos() / "left/checkerboard/1.png", 2);
  writePhoto(photos() / "right/checkerboard/1.png", 3);
  auto photographs = open({photos() / "right", photos() / "left"});
  ASSERT_EQ(photographs.placeCount(), 2);
  EXPECT_TRUE(photographs.hasProjector("p3"));
  EXPECT_EQ(photographs.checkerboardCount(), 2);
  EXPECT_EQ(codeOf(photographs.nextCheckerboard()->photo), 3);
  EXPECT_EQ(codeOf(photographs.nextCheckerboard()->photo), 2);
  EXPECT_FALSE(photographs.nextCheckerboard());
  EXPECT_EQ(photographs.checkerboardPlace(), (photos() / "right/checkerboard").string() + ", " +
                                                 (photos() / "left/checkerboard").string() + " (.png or .jpg)");
}

TEST_F(CaptureTest, PlacesAreInTheOrderOfTheirNumbers) {
  for (int i = 1; i <= 11; ++i) writePhoto(photos() / ("place" + std::to_string(i)) / "p1/white.png", i);
  auto photographs = open({photos()});
  ASSERT_EQ(photographs.placeCount(), 11);
  for (int i = 0; i < 11; ++i) {
    photographs.choosePlace(i);
    EXPECT_EQ(codeSeen(photographs, "p1", "white"), i + 1);
  }
}

TEST_F(CaptureTest, TheCameraIsKnownFromTheFirstFolderThatSays) {
  writeTwoPlaces();
  devices::writeFileAtomically(photos() / "right/camera.yaml",
                               "size: [640, 480]\nfx: 500\nfy: 501\ncx: 320\ncy: 240\n"
                               "radial: [0.1, 0, 0]\ntangential: [0, 0]\n");
  auto photographs = open({photos() / "left", photos() / "right"});
  const auto camera = photographs.knownCamera();
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->fx, 500);
  EXPECT_EQ(camera->size, (devices::Size{640, 480}));
}

TEST_F(CaptureTest, ErrorsNameTheFile) {
  EXPECT_THROW((void)open({photos()}), CaptureError);
  writeTwoPlaces();
  auto photographs = open({photos()});
  photographs.choosePlace(1);
  const auto messageOf = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const CaptureError& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_THAT(messageOf([&] { (void)photographs.fiducials(); }), HasSubstr("right/fiducials.png"));
  EXPECT_THAT(messageOf([&] { (void)codeSeen(photographs, "p2", "bit3"); }), HasSubstr("right/p2/bit3.png"));
  std::ofstream(photos() / "right/p2/bit3.png") << "no picture";
  EXPECT_THAT(messageOf([&] { (void)codeSeen(photographs, "p2", "bit3"); }), HasSubstr("right/p2/bit3.png"));
}

TEST_F(CaptureTest, KeepsNothingUntilAskedAndThenWhatWasUsed) {
  writeOnePlace(7);
  writePhoto(photos() / "p1/unused.png", 9);
  auto photographs = open({photos()});
  useAll(photographs, {"p1"}, "white");
  EXPECT_FALSE(fs::exists(captures()));
  photographs.keep(Kept::kAll);
  EXPECT_THAT(filesIn(captures()), ElementsAre("checkerboard/1.png", "fiducials.png", "p1/white.png"));
  EXPECT_FALSE(fs::exists(captures().string() + ".new"));
}

TEST_F(CaptureTest, SeveralPlacesAreReadBackFromCaptures) {
  writeTwoPlaces();
  writePhoto(photos() / "right/checkerboard/1.png", 3);
  auto first = open({photos()});
  useAll(first, {"p1", "p2", "p3"}, "white");
  first.keep(Kept::kAll);
  auto again = open({captures()});
  ASSERT_EQ(again.placeCount(), 2);
  EXPECT_EQ(again.checkerboardCount(), 2);
  EXPECT_EQ(again.stamp("patterns"), first.stamp("patterns"));
  EXPECT_EQ(codeSeen(again, "p2", "white"), 12);
  again.choosePlace(1);
  EXPECT_EQ(codeSeen(again, "p2", "white"), 22);
  again.keep(Kept::kAll);  // nothing to copy, nothing lost
  EXPECT_EQ(filesIn(captures()).size(), 7U);
}

TEST_F(CaptureTest, AnEarlierNumberOfPlacesLeavesNothingBehind) {
  writeTwoPlaces();
  auto two = open({photos()});
  useAll(two, {"p1", "p2", "p3"}, "white");
  two.keep(Kept::kAll);
  fs::remove_all(photos());
  writeOnePlace(50);
  auto one = open({photos()});
  useAll(one, {"p1"}, "white");
  one.keep(Kept::kAll);
  EXPECT_THAT(filesIn(captures()), ElementsAre("checkerboard/1.png", "fiducials.png", "p1/white.png"));
  fs::remove_all(photos());
  writeTwoPlaces();
  auto twoAgain = open({photos()});
  useAll(twoAgain, {"p1", "p2", "p3"}, "white");
  twoAgain.keep(Kept::kAll);
  EXPECT_THAT(filesIn(captures()), ElementsAre("checkerboard/1.png", "place1/fiducials.png", "place1/p1/white.png",
                                               "place1/p2/white.png", "place2/p2/white.png", "place2/p3/white.png"));
}

TEST_F(CaptureTest, PhotographsOfAnotherMethodOrEndingGo) {
  writePhoto(captures() / "p1/bit0.png", 1);
  writePhoto(captures() / "p2/white.png", 2);
  writePhoto(captures() / "fiducials.jpg", 3);
  writePhoto(captures() / "checkerboard/20.png", 4);
  devices::writeFileAtomically(captures() / "camera.yaml", "of another camera");
  devices::writeFileAtomically(captures() / "notes.txt", "mine");
  writeOnePlace(7);
  auto photographs = open({photos()});
  useAll(photographs, {"p1"}, "white");
  photographs.keep(Kept::kAll);
  EXPECT_THAT(filesIn(captures()),
              ElementsAre("checkerboard/1.png", "fiducials.png", "notes.txt", "p1/white.png", "p2/white.png"));
}

TEST_F(CaptureTest, AProjectorMayBeCalledLikeAPlace) {
  writePhoto(captures() / "place1/white.png", 1);
  writeOnePlace(7);
  auto photographs = open({photos()});
  useAll(photographs, {"p1"}, "white");
  photographs.keep(Kept::kAll);
  EXPECT_TRUE(fs::exists(captures() / "place1/white.png"));
}

TEST_F(CaptureTest, TheStampChangesWithAPhotographOfAnyPlace) {
  writeTwoPlaces();
  auto photographs = open({photos()});
  const std::string patterns = photographs.stamp("patterns");
  const std::string fiducials = photographs.stamp("fiducials");
  const std::string checkerboard = photographs.stamp("checkerboard");
  writePhoto(photos() / "right/p3/bit0.png", 1);
  EXPECT_NE(photographs.stamp("patterns"), patterns);
  writePhoto(photos() / "right/fiducials.png", 1);
  EXPECT_NE(photographs.stamp("fiducials"), fiducials);
  EXPECT_EQ(photographs.stamp("checkerboard"), checkerboard);
}

ProjectorPatterns patternsFor(const std::string& name, devices::Size size, Method method) {
  return {name, size, patternsOf(method, size)};
}

TEST(ExposureName, SaysTheExposure) {
  EXPECT_NEAR(exposureOfName("red-128@1_60").value(), 1.0 / 60, 1e-12);
  EXPECT_EQ(exposureOfName("red-128@0.5"), 0.5);
  EXPECT_EQ(exposureOfName("red-128@2"), 2);
  for (const auto* name : {"red-128", "red-128@", "red-128@a", "red-128@1_", "red-128@_60", "red-128@1_0", "r@-1",
                           "r@0", "r@nan", "r@inf", "r@1s"}) {
    EXPECT_FALSE(exposureOfName(name)) << name;
  }
  EXPECT_EQ(patternOfName("red-128@1_60"), "red-128");
  EXPECT_EQ(patternOfName("red-128"), "red-128");
  for (const double seconds : {1e-4, 1.0 / 60, 0.0274605, 30.0}) {
    EXPECT_NEAR(exposureOfName(nameWithExposure("blue-008", seconds)).value(), seconds, 1e-5 * seconds);
  }
}

TEST_F(CaptureTest, FindsEveryExposureOfAPattern) {
  writeOnePlace(7);
  writePhoto(photos() / "p1/red-128@1_4.png", 60);
  writePhoto(photos() / "p1/red-128@1.png", 240);
  writePhoto(photos() / "p1/red-135.png", 9);
  auto photographs = open({photos()});
  EXPECT_FALSE(photographs.exposureRange());
  EXPECT_TRUE(photographs.hasExposures("p1", "red-128"));
  EXPECT_FALSE(photographs.hasExposures("p1", "red-12"));
  const auto shots = photographs.exposures("p1", "red-128");
  ASSERT_EQ(shots.size(), 2U);
  EXPECT_EQ(shots[0].seconds, 1);
  EXPECT_EQ(shots[1].seconds, 0.25);
  EXPECT_EQ(shots[1].photo.at(0, 0), 60);
  EXPECT_FALSE(photographs.exposures("p1", "red-135").front().seconds);
  writePhoto(photos() / "p1/red-143@x.png", 9);
  EXPECT_THAT([&] { (void)photographs.exposures("p1", "red-143"); },
              ::testing::ThrowsMessage<CaptureError>(HasSubstr("p1/red-143@x.png: after the @")));
  EXPECT_THAT(
      [&] { (void)photographs.exposures("p1", "red-151"); },
      ::testing::ThrowsMessage<CaptureError>(HasSubstr("p1/red-151.png (or .jpg): this photograph is missing")));
}

TEST_F(CaptureTest, PhotographsOfTheResponseAreAKindOfTheirOwn) {
  writeOnePlace(7);
  auto first = open({photos()});
  const std::string patterns = first.stamp("patterns");
  const std::string response = first.stamp("response");
  useAll(first, {"p1"}, "white");
  first.keep(Kept::kAll);
  writePhoto(captures() / "p1/red-120@1.png", 1);
  writePhoto(photos() / "p1/red-128@1.png", 60);
  auto second = open({photos()});
  EXPECT_EQ(second.stamp("patterns"), patterns);
  EXPECT_NE(second.stamp("response"), response);
  useAll(second, {"p1"}, "white");
  (void)second.exposures("p1", "red-128");
  fs::remove(captures() / "p1/white.png");
  writePhoto(captures() / "p1/black.png", 5);
  second.keep(Kept::kResponse);
  EXPECT_THAT(filesIn(captures()),
              ElementsAre("checkerboard/1.png", "fiducials.png", "p1/black.png", "p1/red-128@1.png"));
  second.keep(Kept::kAll);
  EXPECT_THAT(filesIn(captures()),
              ElementsAre("checkerboard/1.png", "fiducials.png", "p1/red-128@1.png", "p1/white.png"));
}

TEST_F(CaptureTest, WritesTheLevelsOfAResponseWhereTheyAreWanted) {
  writePatterns(photos(), {{"p1", {64, 48}, responsePatterns({64, 48})}, patternsFor("p2", {80, 60}, Method::kBlobs)});
  EXPECT_EQ(filesIn(photos() / "p1").size(), 98U);
  const auto level = devices::readPng8(photos() / "p1/green-064.png");
  EXPECT_EQ(level.size(), (devices::Size{64, 48}));
  ASSERT_EQ(level.channels(), 3);
  EXPECT_EQ(level.at(63, 47, 0), 0);
  EXPECT_EQ(level.at(63, 47, 1), 64);
  EXPECT_EQ(level.at(63, 47, 2), 0);
  EXPECT_EQ(devices::readPng8(photos() / "p1/blue-255.png").at(0, 0, 2), 255);
  std::ifstream file(photos() / "README.txt");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_THAT(text, HasSubstr("The response of p1\n"));
  EXPECT_THAT(text, HasSubstr("red-128@1_60.jpg"));
}

TEST_F(CaptureTest, WritesThePatternsOfAMethodWithInstructions) {
  writePatterns(photos(), {patternsFor("p1", {64, 48}, Method::kDense), patternsFor("p2", {80, 60}, Method::kDense)},
                Method::kDense);
  EXPECT_EQ(devices::readPng8(photos() / "p2/dense-xphase3.png").size(), (devices::Size{80, 60}));
  std::ifstream file(photos() / "README.txt");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_THAT(text, HasSubstr("p2/dense-row0.png"));
  EXPECT_THAT(text, HasSubstr("from dense-white.png on"));
  EXPECT_THAT(text, HasSubstr("--photos photos/ --method dense"));
  EXPECT_THAT(text, HasSubstr("40 to 60 %"));
  writePatterns(photos() / "blobs", {patternsFor("p1", {64, 48}, Method::kBlobs)});
  EXPECT_TRUE(fs::exists(photos() / "blobs/p1/bit6.png"));
}

}  // namespace
}  // namespace pixelflex::calib
