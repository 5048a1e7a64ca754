#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "calib/store/store.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Output pixelflex(std::vector<std::string> arguments, const std::vector<std::string>& environment = {}) {
  arguments.insert(arguments.begin(), std::string(PIXELFLEX_BIN_DIR) + "/pixelflex");
  return run(arguments, environment);
}

class CliNewCheck : public ::testing::Test {
 protected:
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }
  TemporaryFolder folder_;
};

TEST_F(CliNewCheck, AFlatScreenIsReadyToView) {
  EXPECT_EQ(pixelflex({"new", wall(), "--flat", "1024x768"}).status, 0);
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 0);
  EXPECT_EQ(output.text, wall() + ": no problems\n1 projector, 1 calibrated, a desktop of 1024x768 pixels\n");
}

TEST_F(CliNewCheck, AGridOfScreensIsReadyToView) {
  EXPECT_EQ(pixelflex({"new", "--flat", "2x2:1920x1080", wall()}).status, 0);
  EXPECT_THAT(pixelflex({"check", wall()}).text,
              HasSubstr("4 projectors, 4 calibrated, a desktop of 3840x2160 pixels"));
  const auto loaded = calib::loadWall(wall());
  EXPECT_EQ(loaded.projectors[2].name, "p3");
  EXPECT_EQ(loaded.projectors[2].flatAt, glm::ivec2(0, 1080));
}

TEST_F(CliNewCheck, ARigIsReadyToCalibrate) {
  const std::string rig = std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/report-8.yaml";
  EXPECT_EQ(pixelflex({"new", wall(), "--rig", rig}).status, 0);
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_THAT(output.text, HasSubstr("8 projectors; not calibrated yet: pixelflex calibrate " + wall()));
}

TEST_F(CliNewCheck, ABadRigIsRefusedWithItsLineAndNothingIsMade) {
  std::ofstream(folder_ / "rig.yaml") << "format: pixelflex-rig\nversion: 1\nnonsense: 3\n";
  const Output output = pixelflex({"new", wall(), "--rig", (folder_ / "rig.yaml").string()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("pixelflex-new: "));
  EXPECT_THAT(output.text, HasSubstr("rig.yaml:3:1: unknown key \"nonsense\""));
  EXPECT_FALSE(fs::exists(wall()));
}

TEST_F(CliNewCheck, AnExistingWallStays) {
  ASSERT_EQ(pixelflex({"new", wall(), "--flat", "1024x768"}).status, 0);
  const Output output = pixelflex({"new", wall(), "--flat", "640x480"});
  EXPECT_EQ(output.status, 1);
  EXPECT_EQ(output.text, "pixelflex-new: " + wall() + "/wall.yaml: there is a wall already; choose another folder\n");
  EXPECT_EQ(calib::loadWall(wall()).projectors[0].resolution, (devices::Size{1024, 768}));
}

TEST_F(CliNewCheck, WithoutADisplayNewSaysWhatToDo) {
  const Output output = pixelflex({"new", wall()}, {"DISPLAY="});
  EXPECT_EQ(output.status, 1);
  EXPECT_EQ(output.text, "pixelflex-new: no display to look for monitors on: set DISPLAY, or use --rig or --flat\n");
  EXPECT_FALSE(fs::exists(wall()));
}

TEST_F(CliNewCheck, ADisplayThatDoesNotAnswerIsNamed) {
  const Output output = pixelflex({"new", wall()}, {"DISPLAY=:60999"});
  EXPECT_EQ(output.status, 1);
  EXPECT_TRUE(output.text.starts_with("pixelflex-new: ")) << output.text;
  EXPECT_THAT(output.text, HasSubstr(":60999"));
  EXPECT_FALSE(fs::exists(wall()));
}

TEST_F(CliNewCheck, TheMonitorsFoundBecomeProjectors) {
  const XServer server([](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "1280x720x24", "-nolisten", "tcp"};
  });
  const Output output = pixelflex({"new", wall()}, {"DISPLAY=" + server.display()});
  ASSERT_EQ(output.status, 0) << output.text;
  const auto loaded = calib::loadWall(wall());
  ASSERT_EQ(loaded.projectors.size(), 1U);
  EXPECT_EQ(loaded.projectors[0].resolution, (devices::Size{1280, 720}));
  EXPECT_EQ(loaded.projectors[0].output.kind, calib::OutputKind::kMonitor);
  EXPECT_EQ(pixelflex({"check", wall()}).status, 0);
}

TEST_F(CliNewCheck, WrongUsageIsStatusTwo) {
  const std::vector<std::vector<std::string>> usages = {{"new"},
                                                        {"new", wall(), "--flat", "1024"},
                                                        {"new", wall(), "--flat", "9x9:64x64"},
                                                        {"new", wall(), "--flat", ""},
                                                        {"new", wall(), "--nonsense"},
                                                        {"new", wall(), "--flat", "64x64", "--rig", "x"},
                                                        {"check"},
                                                        {"check", wall(), "more"}};
  for (const auto& usage : usages) {
    const Output output = pixelflex(usage);
    EXPECT_EQ(output.status, 2) << ::testing::PrintToString(usage) << output.text;
    EXPECT_TRUE(output.text.starts_with("pixelflex-" + usage[0] + ": ")) << output.text;
    EXPECT_FALSE(fs::exists(wall()));
  }
}

TEST_F(CliNewCheck, HelpAndVersion) {
  for (const std::string name : {"new", "check"}) {
    const Output help = pixelflex({name, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.text, HasSubstr("Usage: pixelflex " + name));
    const Output version = pixelflex({name, "--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_TRUE(version.text.starts_with("pixelflex-" + name + " ")) << version.text;
  }
}

TEST_F(CliNewCheck, CheckRefusesReadingsThatAreNoProjectors) {
  ASSERT_EQ(pixelflex({"new", wall(), "--rig", PIXELFLEX_SOURCE_DIR "/config/rigs/mini-2.yaml"}).status, 0);
  std::string clipped = "value,red,green,blue\n";
  for (int code = 0; code < 256; ++code) {
    const std::string light = std::to_string(std::min(code, 100));
    clipped += std::to_string(code) + "," + light + "," + light + "," + light + "\n";
  }
  std::ofstream(wall() + "/readings/p1.csv") << clipped;
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("readings/p1.csv: the red readings are clipped from value 100 on"));
}

TEST_F(CliNewCheck, CheckListsAllProblemsOfAllFiles) {
  ASSERT_EQ(pixelflex({"new", wall(), "--flat", "2x1:1024x768"}).status, 0);
  calib::Wall changed = calib::loadWall(wall());
  changed.projectors[0].gamma = "readings/p1.csv";
  saveWall(wall(), changed);
  fs::create_directory(wall() + "/readings");
  std::ofstream(wall() + "/readings/p1.csv") << "0,1,1,1\n1,1,1\n";
  calib::Calibration calibration = calib::loadCalibration(wall());
  calibration.projectors[1].alpha = "calibration/p2-alpha.png";
  saveCalibration(wall(), calibration);
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("/readings/p1.csv:2: expected four columns"));
  EXPECT_THAT(output.text, HasSubstr("/readings/p1.csv: expected 256 readings, found 2"));
  EXPECT_THAT(output.text, HasSubstr("alpha: there is no file"));
  EXPECT_THAT(output.text, HasSubstr("pixelflex-check: " + wall() + ": 3 problems\n"));
}

TEST_F(CliNewCheck, CheckListsAllProblemsOfOneFile) {
  fs::create_directory(wall());
  std::ofstream(wall() + "/wall.yaml") << "format: pixelflex-wall\nversion: 1\nblnd: {}\ncamera: {source: none}\n"
                                          "projectors:\n  - {name: p 1, resolution: [1, 2000]}\n";
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("/wall.yaml:3:1: unknown key \"blnd\"; did you mean \"blend\"?\n"));
  EXPECT_THAT(output.text, HasSubstr("/wall.yaml:6:12: name: \"p 1\" may only hold"));
  EXPECT_THAT(output.text, HasSubstr("/wall.yaml:6:30: resolution: expected a whole number from 16 to 16384"));
  EXPECT_THAT(output.text, HasSubstr(": 3 problems\n"));
}

TEST_F(CliNewCheck, CheckLooksIntoTheRig) {
  const std::string rig = std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/report-8.yaml";
  ASSERT_EQ(pixelflex({"new", wall(), "--rig", rig}).status, 0);
  std::ofstream(wall() + "/rig.yaml", std::ios::app) << "nonsense: 1\n";
  const Output output = pixelflex({"check", wall()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("unknown key \"nonsense\""));
}

}  // namespace
}  // namespace pixelflex::testing
