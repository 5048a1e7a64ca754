#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;

TEST(ViewDepthTest, TenBitsAreWrittenInSixteen) {
  const TemporaryFolder folder;
  const std::string wall = (folder / "wall").string();
  const std::string shot = (folder / "shot").string();
  ASSERT_EQ(runProgram("new", {wall, "--flat", "320x240"}).status, 0);
  XvncServer server({.size = {320, 240}});
  server.x().query({"xsetroot", "-solid", "#3380c0"});
  const Output run =
      runProgram("view", {wall, server.unixAddress(), "--headless", "--screenshot", shot, "--depth", "10"});
  ASSERT_EQ(run.status, 0) << run.text;
  const auto frame = devices::readPng16(fs::path(shot) / "p1.png");
  const auto desktop = devices::readPng8(fs::path(shot) / "desktop.png");
  ASSERT_EQ(frame.size(), desktop.size());
  bool between = false;  // a value that eight bits cannot hold
  for (std::size_t i = 0; i < frame.samples().size(); ++i) {
    const double code = frame.samples()[i] / 65535.0 * 1023;
    ASSERT_NEAR(code, std::round(desktop.samples()[i] / 255.0 * 1023), 0.02);
    between = between || frame.samples()[i] % 257 != 0;
  }
  EXPECT_TRUE(between);
}

TEST(ViewDepthTest, OtherDepthsAreWrongUsage) {
  const Output run = runProgram("view", {"wall", "localhost:1", "--headless", "--depth", "12"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.text, ::testing::HasSubstr("--depth"));
}

}  // namespace
}  // namespace pixelflex::testing
