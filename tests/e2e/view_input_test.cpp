#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>

#include "calib/store/store.h"
#include "tests/e2e/mini_wall.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// Asks until the answer holds the word, for at most ten seconds; returns the last answer.
std::string askUntil(XServer& x, const std::vector<std::string>& command, const std::string& word) {
  std::string answer;
  for (int i = 0; i < 100; ++i) {
    try {
      answer = x.query(command);
    } catch (const std::runtime_error&) {
      answer.clear();  // xdotool fails as long as there is no such window
    }
    if (answer.find(word) != std::string::npos) break;
    std::this_thread::sleep_for(100ms);
  }
  return answer;
}

class InputTest : public ::testing::Test {
 protected:
  std::unique_ptr<Process> startViewer(const std::string& address, std::vector<std::string> more = {}) {
    std::vector<std::string> command = {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(), address,
                                        "--pointer", "screen"};
    command.insert(command.end(), more.begin(), more.end());
    return std::make_unique<Process>(
        command, ProcessOptions{.environment = {"DISPLAY=" + screen_.x().display()}, .log = folder_ / "log"});
  }
  /// A flat wall of two screens side by side on the test's display.
  void makeFlatWall() {
    ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "2x1:600x400"}).status, 0);
    calib::Wall flat = calib::loadWall(wall());
    for (std::size_t i = 0; i < 2; ++i) {
      flat.projectors[i].output = {
          .kind = calib::OutputKind::kDisplay, .display = screen_.x().display(), .at = {static_cast<int>(i) * 700, 50}};
    }
    calib::saveWall(wall(), flat);
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  const TemporaryFolder folder_;
  X11vncServer screen_{{1400, 700}};
};

TEST_F(InputTest, ThePointerReachesTheDesktopThroughEachScreen) {
  XvncServer server({.size = {1200, 400}});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress());
  askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex p2"}, "\n");
  std::this_thread::sleep_for(1s);
  screen_.x().query({"xdotool", "mousemove", "123", "150"});
  EXPECT_THAT(askUntil(server.x(), {"xdotool", "getmouselocation"}, "x:123 y:100"), HasSubstr("x:123 y:100"));
  screen_.x().query({"xdotool", "mousemove", "800", "250"});  // the second screen's (100, 200): desktop (700, 200)
  EXPECT_THAT(askUntil(server.x(), {"xdotool", "getmouselocation"}, "x:700 y:200"), HasSubstr("x:700 y:200"));
}

TEST_F(InputTest, KeysAndButtonsReachTheDesktop) {
  XvncServer server({.size = {1200, 400}});
  const fs::path typed = folder_ / "typed";
  server.x().start(
      {"xterm", "-geometry", "60x20+0+0", "-e", "bash", "-c", "read line; echo \"$line\" > " + typed.string()});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress());
  askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex p1"}, "\n");
  std::this_thread::sleep_for(1500ms);
  screen_.x().query({"xdotool", "mousemove", "150", "150"});
  screen_.x().query({"xdotool", "click", "1"});
  std::this_thread::sleep_for(300ms);
  screen_.x().query({"xdotool", "type", "--delay", "40", "Wall of 8, (ok)!"});
  screen_.x().query({"xdotool", "key", "Return"});
  for (int i = 0; i < 100 && !fs::exists(typed); ++i) std::this_thread::sleep_for(100ms);
  EXPECT_EQ(textOf(typed), "Wall of 8, (ok)!\n");
}

TEST_F(InputTest, ViewOnlySendsNothing) {
  XvncServer server({.size = {1200, 400}});
  server.x().query({"xdotool", "mousemove", "1000", "300"});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress(), {"--view-only"});
  askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex p1"}, "\n");
  std::this_thread::sleep_for(1s);
  screen_.x().query({"xdotool", "mousemove", "123", "150"});
  std::this_thread::sleep_for(1s);
  EXPECT_THAT(server.x().query({"xdotool", "getmouselocation"}), HasSubstr("x:1000 y:300"));
}

TEST_F(InputTest, TheRoomOfASimulatedWallTakesThePointerThroughTheCalibration) {
  makeMiniWall(wall());
  const auto display = calib::loadCalibration(wall()).display.value();
  XvncServer server({.size = display.resolution});
  const auto viewer = startViewer(server.unixAddress());
  const std::string window = askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "the room"}, "\n");
  std::this_thread::sleep_for(2s);
  const std::string id = window.substr(0, window.find('\n'));
  // The room shows the whole screen, as large as fits: its middle is the screen's middle.
  const std::string geometry = screen_.x().query({"xdotool", "getwindowgeometry", "--shell", id});
  const auto number = [&](const std::string& key) {
    return std::stoi(geometry.substr(geometry.find(key) + key.size()));
  };
  const int x = number("WIDTH=") / 2;
  const int y = number("HEIGHT=") / 2;
  screen_.x().query({"xdotool", "mousemove", "--window", id, std::to_string(x), std::to_string(y)});
  const glm::dvec2 middle{2479 / 2.0, 1636 / 2.0};  // of the mini rig's screen, wall units
  const double scale = display.resolution.width / (display.right - display.left);
  const glm::dvec2 expected = (middle - glm::dvec2(display.left, display.top)) * scale;
  double distance = 1e9;
  for (int i = 0; i < 50 && distance > 4; ++i) {
    std::this_thread::sleep_for(100ms);
    const std::string at = server.x().query({"xdotool", "getmouselocation"});
    const glm::dvec2 found{std::stod(at.substr(2)), std::stod(at.substr(at.find("y:") + 2))};
    distance = std::hypot(found.x - expected.x, found.y - expected.y);
  }
  EXPECT_LE(distance, 4) << "one window pixel is about two desktop pixels";
}

TEST_F(InputTest, TheEscapeKeysEndTheViewer) {
  XvncServer server({.size = {1200, 400}});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress());
  askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex p1"}, "\n");
  std::this_thread::sleep_for(1s);
  screen_.x().query({"xdotool", "mousemove", "150", "150"});
  screen_.x().query({"xdotool", "click", "1"});
  screen_.x().query({"xdotool", "key", "ctrl+alt+q"});
  EXPECT_EQ(viewer->wait(10s), 0);
}

}  // namespace
}  // namespace pixelflex::testing
