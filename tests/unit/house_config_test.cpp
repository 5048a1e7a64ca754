#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "calib/simulate/rig.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;

fs::path configFolder() {
  return fs::path(PIXELFLEX_SOURCE_DIR) / "config";
}

std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

TEST(HouseConfig, EveryRigLoadsAndMakesAWall) {
  int rigs = 0;
  for (const auto& file : filesBelow(configFolder() / "rigs")) {
    SCOPED_TRACE(file.string());
    ASSERT_EQ(file.extension(), ".yaml");
    const calib::Rig rig = calib::loadRig(file);
    const calib::Wall wall = calib::wallOfRig(rig, "rig.yaml");
    EXPECT_EQ(calib::parseWall(calib::formatWall(wall), "wall.yaml"), wall);
    EXPECT_EQ(wall.projectors.size(), rig.projectors.size());
    ++rigs;
  }
  EXPECT_GE(rigs, 1);
}

TEST(HouseConfig, EveryWallIsInGoodOrder) {
  int walls = 0;
  for (const auto& entry : fs::directory_iterator(configFolder() / "walls")) {
    SCOPED_TRACE(entry.path().string());
    std::string problems;
    for (const auto& problem : calib::checkWall(entry.path())) problems += problem.text() + "\n";
    EXPECT_EQ(problems, "");
    ++walls;
  }
  EXPECT_GE(walls, 2);
}

TEST(HouseConfig, EveryFileBelongsToARigAWallOrAPicture) {
  for (const auto& file : filesBelow(configFolder())) {
    const std::string path = fs::relative(file, configFolder()).string();
    const bool picture = path.starts_with("pictures/");
    EXPECT_TRUE(path == "README.md" || path.starts_with("rigs/") || path.starts_with("walls/") || picture) << path;
    if (picture) {
      EXPECT_NO_THROW((void)devices::readPng8(file)) << path;
    }
  }
}

}  // namespace
}  // namespace pixelflex::testing
