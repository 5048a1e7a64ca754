#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
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
    EXPECT_TRUE(path == "README.md" || path.starts_with("rigs/") || path.starts_with("walls/") ||
                path.starts_with("session/") || picture)
        << path;
    if (picture) {
      EXPECT_NO_THROW((void)devices::readPng8(file)) << path;
    }
  }
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(HouseConfig, TheSessionsFilesSayWhatIsStarted) {
  using ::testing::Contains;
  const auto unit = linesOf(configFolder() / "session/pixelflex.service.in");
  for (const auto* line :
       {"[Unit]", "[Service]", "[Install]", "ExecStart=@prefix@/bin/pixelflex $PIXELFLEX_ARGUMENTS",
        "Environment=\"PIXELFLEX_ARGUMENTS=desktop %h/wall\"", "WantedBy=graphical-session.target"}) {
    EXPECT_THAT(unit, Contains(line));
  }
  const auto serve = linesOf(configFolder() / "session/pixelflex-serve.service.in");
  EXPECT_THAT(serve, Contains("ExecStart=@prefix@/bin/pixelflex serve $PIXELFLEX_SERVE_ARGUMENTS"));
  EXPECT_THAT(serve, Contains("Environment=\"PIXELFLEX_SERVE_ARGUMENTS=%h/wall --http 8080\""));
  const auto entry = linesOf(configFolder() / "session/pixelflex.desktop.in");
  ASSERT_FALSE(entry.empty());
  EXPECT_EQ(entry.front(), "[Desktop Entry]");
  // As the specification has it: a quoted argument's quotes and dollars carry two backslashes.
  const std::string exec = R"(Exec=sh -c "exec @prefix@/bin/pixelflex desktop \\"\\$HOME/wall\\"")";
  for (const std::string line : {"Type=Application", "Name=PixelFlex", "Terminal=false", exec.c_str()}) {
    EXPECT_THAT(entry, Contains(line));
  }
}

}  // namespace
}  // namespace pixelflex::testing
