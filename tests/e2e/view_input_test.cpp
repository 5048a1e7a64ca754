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

/// Asks until the answer holds the word, for at most forty seconds; returns the last answer.
std::string askUntil(XServer& x, const std::vector<std::string>& command, const std::string& word) {
  std::string answer;
  for (int i = 0; i < 400; ++i) {
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
  /// Moves the pointer there on the screen until it is elsewhere on the desktop, as "x:1 y:2 ".
  bool reaches(XServer& desktop, glm::ivec2 onScreen, const std::string& onDesktop) {
    for (int i = 0; i < 400; ++i) {
      screen_.x().query({"xdotool", "mousemove", std::to_string(onScreen.x), std::to_string(onScreen.y)});
      if (desktop.query({"xdotool", "getmouselocation"}).starts_with(onDesktop)) return true;
      std::this_thread::sleep_for(100ms);
    }
    return false;
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  const TemporaryFolder folder_;
  X11vncServer screen_{{1400, 700}};
};

TEST_F(InputTest, ThePointerReachesTheDesktopThroughEachScreen) {
  XvncServer server({.size = {1200, 400}});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress());
  EXPECT_TRUE(reaches(server.x(), {123, 150}, "x:123 y:100 ")) << textOf(folder_ / "log");
  EXPECT_TRUE(reaches(server.x(), {800, 250}, "x:700 y:200 ")) << "the second screen's (100, 200)";
}

TEST_F(InputTest, KeysAndButtonsReachTheDesktop) {
  XvncServer server({.size = {1200, 400}});
  const fs::path typed = folder_ / "typed";
  server.x().start(
      {"xterm", "-geometry", "60x20+0+0", "-e", "bash", "-c", "read line; echo \"$line\" > " + typed.string()});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress());
  server.x().query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
  ASSERT_TRUE(reaches(server.x(), {150, 150}, "x:150 y:100 ")) << textOf(folder_ / "log");
  screen_.x().query({"xdotool", "click", "1"});
  screen_.x().query({"xdotool", "type", "--delay", "40", "to be removed"});
  screen_.x().query({"xdotool", "key", "--delay", "40", "ctrl+u"});
  screen_.x().query({"xdotool", "type", "--delay", "40", "Wall of 8, (ok)!"});
  screen_.x().query({"xdotool", "key", "Return"});
  for (int i = 0; i < 400 && textOf(typed).empty(); ++i) std::this_thread::sleep_for(100ms);
  EXPECT_EQ(textOf(typed), "Wall of 8, (ok)!\n");
}

TEST_F(InputTest, ViewOnlySendsNothing) {
  XvncServer server({.size = {1200, 400}});
  server.x().query({"xdotool", "mousemove", "1000", "300"});
  makeFlatWall();
  const auto viewer = startViewer(server.unixAddress(), {"--view-only", "--stats"});
  askUntil(screen_.x(), {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex p1"}, "\n");
  for (int i = 0; i < 400 && textOf(folder_ / "log").find("the first picture") == std::string::npos; ++i) {
    std::this_thread::sleep_for(100ms);
  }
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
  const std::string id = window.substr(0, window.find('\n'));
  // The room shows the whole screen, as large as fits: its middle is the screen's middle.
  const std::string geometry = screen_.x().query({"xdotool", "getwindowgeometry", "--shell", id});
  const auto number = [&](const std::string& key) {
    return std::stoi(geometry.substr(geometry.find(key) + key.size()));
  };
  const int x = number("WIDTH=") / 2;
  const int y = number("HEIGHT=") / 2;
  const glm::dvec2 middle{2479 / 2.0, 1636 / 2.0};  // of the mini rig's screen, wall units
  const double scale = display.resolution.width / (display.right - display.left);
  const glm::dvec2 expected = (middle - glm::dvec2(display.left, display.top)) * scale;
  double distance = 1e9;
  for (int i = 0; i < 400 && distance > 4; ++i) {
    screen_.x().query({"xdotool", "mousemove", "--window", id, std::to_string(x), std::to_string(y)});
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
  ASSERT_TRUE(reaches(server.x(), {150, 150}, "x:150 y:100 ")) << textOf(folder_ / "log");
  for (int i = 0; i < 400 && viewer->running(); ++i) {
    screen_.x().query({"xdotool", "key", "ctrl+alt+q"});
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_EQ(viewer->wait(1s), 0);
}

}  // namespace
}  // namespace pixelflex::testing
