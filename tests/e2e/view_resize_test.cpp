// The wall's own size asked for, and a new calibration while the wall is shown.
#include <gmock/gmock.h>

#include "calib/store/store.h"
#include "tests/e2e/view_lost.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class ResizeTest : public LostTest {
 protected:
  [[nodiscard]] Output shoot(const std::string& server, std::vector<std::string> more) const {
    more.insert(more.begin(), {wall().string(), server, "--headless", "--screenshot", (folder_ / "shot").string()});
    return runProgram("view", more);
  }
  [[nodiscard]] devices::Size shown() const { return devices::readPng8(folder_ / "shot/desktop.png").size(); }

  /// The wall becomes one projector of 320x240 that shows all of the desktop, darkened by a mask.
  void calibrateWith(double alpha, devices::Size desktop = {320, 240}) const {
    devices::Image16 mask({320, 240}, 1);
    std::ranges::fill(mask.samples(), static_cast<std::uint16_t>(65535 * alpha));
    fs::create_directories(wall() / "calibration");
    devices::writePng(wall() / "calibration/p1-alpha.png", mask);
    calib::Calibration calibration = calib::loadCalibration(wall());
    calibration.projectors.resize(1);
    calibration.projectors[0].flatAt.reset();
    calibration.projectors[0].alpha = "calibration/p1-alpha.png";
    calibration.display = calib::Display{0, 0, 320, 240, desktop};
    calib::saveCalibration(wall(), calibration);
  }
};

TEST_F(ResizeTest, TheServerTakesTheWallsSize) {
  const auto server = startServer("800x600");
  EXPECT_EQ(shoot("unix:" + socket(), {}).status, 0);
  EXPECT_EQ(shown(), (devices::Size{800, 600})) << "not asked for";
  const Output output = shoot("unix:" + socket(), {"--resize", "--settle", "2000"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_EQ(shown(), (devices::Size{640, 240}));
  EXPECT_EQ(countOf(server->query({"xrandr"}), " connected "), 1u);
}

TEST_F(ResizeTest, AScreenForEachProjector) {
  const auto server = startServer("800x600");
  const Output output = shoot("unix:" + socket(), {"--resize", "--screens", "projectors", "--settle", "2000"});
  EXPECT_EQ(output.status, 0) << output.text;
  const std::string screens = server->query({"xrandr"});
  EXPECT_THAT(screens, HasSubstr("320x240+0+0"));
  EXPECT_THAT(screens, HasSubstr("320x240+320+0"));
  server->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  ASSERT_EQ(shoot("unix:" + socket(), {}).status, 0);
  EXPECT_TRUE(wallPicture() == grabRoot(server->display()));
}

TEST_F(ResizeTest, AServerThatCannotIsShownScaled) {
  X11vncServer fixed({400, 300});
  const Output output = shoot(fixed.tcpAddress(), {"--resize"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_THAT(output.text, HasSubstr("does not let viewers change its desktop's size; it is shown scaled"));
  EXPECT_EQ(shown(), (devices::Size{400, 300}));
  XvncServer refusing({.size = {400, 300}, .more = {"-AcceptSetDesktopSize=0"}});
  const Output refused = shoot(refusing.unixAddress(), {"--resize"});
  EXPECT_EQ(refused.status, 0) << refused.text;
  EXPECT_THAT(refused.text, HasSubstr("does not let viewers change its desktop's size"));
}

TEST_F(ResizeTest, ANewCalibrationIsShownWhileTheOldOneIs) {
  calibrateWith(1);
  const auto server = startServer("320x240");
  server->query({"xsetroot", "-solid", "#ffffff"});
  const auto viewer =
      startViewer({"--resize", "--stats", "--screenshot", (folder_ / "shot").string(), "--settle", "6000"});
  waitFor("stats:", 1);
  const std::string good = textOf(wall() / "calibration.yaml");
  writeText(wall() / "calibration.yaml", good.substr(0, good.size() / 2));
  waitFor("the new calibration is not shown", 1);
  writeText(wall() / "calibration.yaml", good);
  waitFor("a new calibration is shown", 1);
  calibrateWith(0.25, {400, 300});
  waitFor("a new calibration is shown", 2);
  ASSERT_EQ(viewer->wait(60s), 0) << log();
  EXPECT_EQ(shown(), (devices::Size{400, 300})) << log();
  // sRGB's code of a quarter of the light.
  const devices::Image8 frame = devices::readPng8(folder_ / "shot/p1.png");
  for (const auto& [x, y] : {std::pair{0, 0}, std::pair{160, 120}, std::pair{319, 239}}) {
    EXPECT_NEAR(frame.at(x, y, 1), 137, 1) << x << ", " << y << "\n" << log();
  }
}

}  // namespace
}  // namespace pixelflex::testing
