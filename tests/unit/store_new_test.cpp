#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/new_wall.h"
#include "calib/simulate/rig.h"
#include "calib/store/store.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using calib::FlatGrid;
using calib::NewFile;
using calib::parseFlatGrid;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string textOf(const std::vector<NewFile>& files, const fs::path& path) {
  const auto found = std::ranges::find(files, path, &NewFile::path);
  if (found == files.end()) throw std::runtime_error("no file " + path.string());
  return found->text;
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::ranges::sort(names);
  return names;
}

TEST(StoreNew, ReadsBothSpellingsOfAFlatGrid) {
  EXPECT_EQ(parseFlatGrid("1024x768"), (FlatGrid{1, 1, {1024, 768}}));
  EXPECT_EQ(parseFlatGrid("4x2:1920x1080"), (FlatGrid{4, 2, {1920, 1080}}));
  EXPECT_EQ(parseFlatGrid("2x2:16384x8192"), (FlatGrid{2, 2, {16384, 8192}}));
}

TEST(StoreNew, RefusesOtherGrids) {
  for (const std::string text :
       {"",          "x",         "1024",         "1024x",           "x768",          "1024x768x3",    "2x:1024x768",
        "2x2:",      ":1024x768", "0x768",        "-1x768",          "1024 x768",     "2x2:1024x768:", "15x768",
        "16385x768", "9x9:64x64", "3x1:16384x16", "2x2:16384x16384", "99999999999x1", "1e3x768"}) {
    EXPECT_THROW((void)parseFlatGrid(text), std::invalid_argument) << text;
  }
}

TEST(StoreNew, TheRemarksLeaveEveryKindOfWallAsItIs) {
  calib::Wall camera = exampleWall();
  camera.surface.shape = calib::SurfaceShape::kCamera;
  for (const auto& wall : {exampleWall(), flatWall(1, 1), flatWall(3, 3), camera}) {
    const std::string text = calib::commentedWall(wall);
    EXPECT_EQ(calib::parseWall(text, "wall.yaml"), wall) << text;
    EXPECT_TRUE(text.starts_with("# A PixelFlex wall"));
    EXPECT_GE(std::ranges::count(text, '#'), 10);
    std::string plain;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t first = line.find_first_not_of(' ');
      if (first != std::string::npos && line[first] != '#') plain += line + "\n";
    }
    EXPECT_EQ(plain, calib::formatWall(wall).substr(calib::formatWall(wall).find('\n') + 1));
  }
}

TEST(StoreNew, AFlatWallIsCalibratedFromTheStart) {
  const auto files = calib::filesOfFlatWall({2, 2, {1920, 1080}});
  const auto wall = calib::parseWall(textOf(files, "wall.yaml"), "wall.yaml");
  EXPECT_TRUE(wall.isFlat());
  EXPECT_EQ(wall.projectors[3].flatAt, glm::ivec2(1920, 1080));
  const auto calibration = calib::parseCalibration(textOf(files, "calibration.yaml"), "calibration.yaml");
  EXPECT_EQ(calibration, calib::flatCalibration(wall));
  EXPECT_EQ(calibration.display->resolution, (devices::Size{3840, 2160}));
}

TEST(StoreNew, AMonitorWallIsValidAsItStands) {
  const auto files = calib::filesOfMonitors({{"HDMI-1", {1920, 1080}}, {"DP-2", {1024, 768}}});
  const auto wall = calib::parseWall(textOf(files, "wall.yaml"), "wall.yaml");
  ASSERT_EQ(wall.projectors.size(), 2U);
  EXPECT_EQ(wall.projectors[1].name, "p2");
  EXPECT_EQ(wall.projectors[1].output.monitor, "DP-2");
  EXPECT_EQ(wall.projectors[1].resolution, (devices::Size{1024, 768}));
  EXPECT_EQ(wall.surface.fiducials.size(), 4U);
}

TEST(StoreNew, ARigBecomesAWallInGoodOrder) {
  const std::string path = std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/report-8.yaml";
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const calib::Rig rig = calib::parseRig(text, path);
  const TemporaryFolder folder;
  calib::makeWallFolder(folder.path() / "wall", calib::filesOfRig(rig, text));
  EXPECT_THAT(calib::checkWall(folder.path() / "wall"), IsEmpty());
  EXPECT_EQ(calib::loadRig(folder.path() / "wall" / "rig.yaml"), rig);
  calib::Wall expected = calib::wallOfRig(rig, "rig.yaml");
  expected.blend.uniformity = 0.5;  // new walls have their projectors' light matched, black as well
  expected.blend.evenBlack = true;
  EXPECT_EQ(calib::loadWall(folder.path() / "wall"), expected);
}

TEST(StoreNew, MakesFoldersOnTheWay) {
  const TemporaryFolder folder;
  calib::makeWallFolder(folder.path() / "a" / "b/", {{"readings/p1.csv", "1"}, {"wall.yaml", "2"}});
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("a", "a/b", "a/b/readings", "a/b/readings/p1.csv", "a/b/wall.yaml"));
}

TEST(StoreNew, LeavesAFolderWithAWallAlone) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "wall.yaml") << "mine";
  EXPECT_THROW(calib::makeWallFolder(folder.path(), {{"calibration.yaml", "1"}, {"wall.yaml", "2"}}),
               std::runtime_error);
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("wall.yaml"));
}

TEST(StoreNew, LeavesOtherFilesOfAFolderAlone) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "notes.txt") << "mine";
  calib::makeWallFolder(folder.path(), {{"wall.yaml", "2"}});
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("notes.txt", "wall.yaml"));
  fs::remove(folder.path() / "wall.yaml");
  EXPECT_THROW(calib::makeWallFolder(folder.path(), {{"a/b", "1"}, {"notes.txt", "2"}}), std::runtime_error);
  EXPECT_THAT(namesIn(folder.path()), ElementsAre("notes.txt"));
}

TEST(StoreNew, NothingHalfMadeRemainsAfterAnError) {
  const TemporaryFolder folder;
  // The second file cannot be written: the first is where its folder would have to be.
  EXPECT_THROW(calib::makeWallFolder(folder.path() / "deep" / "wall", {{"x", "1"}, {"x/y", "2"}, {"wall.yaml", "3"}}),
               std::exception);
  EXPECT_THAT(namesIn(folder.path()), IsEmpty());
}

}  // namespace
}  // namespace pixelflex::testing
