// What a viewer tells about its work.
#include <gmock/gmock.h>

#include <regex>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;

class ViewStats : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(runProgram("new", {wall_, "--flat", "2x1:320x240"}).status, 0); }
  Output shoot(std::vector<std::string> more, const std::string& settle = "200") {
    std::vector<std::string> arguments = {
        wall_, server_.unixAddress(), "--headless", "--screenshot", (folder_ / "shot").string(), "--settle", settle};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("view", arguments);
  }

  TemporaryFolder folder_;
  std::string wall_ = (folder_ / "wall").string();
  XvncServer server_{{.size = {640, 240}}};
};

TEST_F(ViewStats, LinesTellOfEveryStage) {
  const Output shown = shoot({"--stats"});
  ASSERT_EQ(shown.status, 0) << shown.text;
  const std::string triple = R"( \d+\.\d/\d+\.\d/\d+\.\d)";
  std::string line = R"(latency: \d+\.\d s  updates [1-9]\d*  median/p99/max ms: )";
  for (const std::string stage : {"receive", "decode", "queue", "upload", "draw", "swap"})
    line += stage + triple + "  ";
  EXPECT_TRUE(std::regex_search(shown.text, std::regex(line + "total" + triple + "\n"))) << shown.text;
  EXPECT_TRUE(std::regex_search(shown.text, std::regex(R"(stats: the first picture \d+\.\d{3} s after the start\n)")))
      << shown.text;
  EXPECT_TRUE(std::regex_search(shown.text, std::regex(R"x(stats: uploads from \S.* GB/s \(.*\)\n)x"))) << shown.text;
}

TEST_F(ViewStats, JsonTellsTheSum) {
  const std::filesystem::path file = folder_ / "stats.json";
  const Output shown = shoot({"--stats-json", file.string()});
  ASSERT_EQ(shown.status, 0) << shown.text;
  EXPECT_THAT(shown.text, ::testing::Not(HasSubstr("latency:")));
  const std::string json = textOf(file);
  const std::string figures = R"(\{"median":\d+\.\d{3},"p99":\d+\.\d{3},"max":\d+\.\d{3}\})";
  std::string line = R"x(\{"first_picture_s":\d+\.\d{3},"uploads":"[^"]+ GB/s \([^"]+\)"\}\n)x";
  line += R"(\{"seconds":\d+\.\d{3},"total":true,"updates":(\d+),"bytes_uploaded":(\d+),)";
  line += R"("outputs_drawn":([2-9]|\d\d+),"pixels_drawn":\d+,"timed_updates":(\d+),"stages_ms":\{)";
  for (const std::string stage : {"receive", "decode", "queue", "upload", "draw", "swap"}) {
    line += "\"" + stage + "\":" + figures + ",";
  }
  std::smatch told;
  ASSERT_TRUE(std::regex_match(json, told, std::regex(line + "\"total\":" + figures + R"(\}\}\n)"))) << json;
  EXPECT_EQ(told[1], told[4]);
  EXPECT_GE(std::stoul(told[2]), 640U * 240U * 4U);
}

TEST_F(ViewStats, APanelIsOnTheFirstProjectorAndThenAllSleeps) {
  const Output shown = shoot({"--stats=overlay", "--show-damage"}, "1600");
  ASSERT_EQ(shown.status, 0) << shown.text;
  EXPECT_THAT(shown.text, ::testing::Not(HasSubstr("stats:")));
  const devices::Image8 desktop = devices::readPng8((folder_ / "shot" / "desktop.png").string());
  const auto differing = [&](const std::string& projector, int left) {
    const devices::Image8 frame = devices::readPng8((folder_ / "shot" / (projector + ".png")).string());
    int count = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x)
        count += std::equal(&frame.at(x, y), &frame.at(x, y) + 3, &desktop.at(left + x, y)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_GT(differing("p1", 0), 500);
  EXPECT_EQ(differing("p2", 320), 0);
}

TEST_F(ViewStats, AFileThatCannotBeWrittenIsSaid) {
  const Output shown = shoot({"--stats-json", (folder_ / "nowhere" / "stats.json").string()});
  EXPECT_EQ(shown.status, 1);
  EXPECT_THAT(shown.text, HasSubstr("pixelflex-view: cannot write to"));
}

}  // namespace
}  // namespace pixelflex::testing
