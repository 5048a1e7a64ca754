#pragma once

#include <gmock/gmock.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "calib/store/store.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {

/// Asks every now and then; false when it has not come true in time.
inline bool comesTrue(const std::function<bool()>& done, std::chrono::seconds timeout = std::chrono::seconds(40)) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!done()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

/// The answer of an X client; empty when it fails.
inline std::string answer(XServer& x, const std::vector<std::string>& command) {
  try {
    return x.query(command);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// A flat wall of screens side by side, each a window on one X server, which shows the desktop of another.
class ScreensTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 300;
  static constexpr int kHeight = 200;

  /// Screen i of `places.size()` is at places[i] of the X screen.
  void makeWall(const std::vector<glm::ivec2>& places) {
    const std::string grid = std::to_string(places.size()) + "x1:300x200";
    ASSERT_EQ(runProgram("new", {wall().string(), "--flat", grid}).status, 0);
    calib::Wall flat = calib::loadWall(wall());
    for (std::size_t i = 0; i < places.size(); ++i) {
      flat.projectors[i].output = {.kind = calib::OutputKind::kDisplay, .display = screen_.display(), .at = places[i]};
    }
    calib::saveWall(wall(), flat);
    desktop_ = std::make_unique<XvncServer>(XvncOptions{.size = {static_cast<int>(places.size()) * kWidth, kHeight}});
  }
  void startViewer(std::vector<std::string> more = {}) { startViewerOf(desktop_->unixAddress(), std::move(more)); }
  void startViewerOf(const std::string& source, std::vector<std::string> more = {}) {
    std::vector<std::string> command = {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(), source};
    command.insert(command.end(), {"--source", "vnc"});
    command.insert(command.end(), more.begin(), more.end());
    viewer_ = std::make_unique<Process>(
        command, ProcessOptions{.environment = {"DISPLAY=" + screen_.display()}, .log = folder_ / "log"});
  }
  /// The desktop's picture is on the X screen there.
  [[nodiscard]] bool shows(glm::ivec2 place, const std::vector<int>& colour) const {
    return showsOn(screen_.display(), place, colour);
  }
  [[nodiscard]] static bool showsOn(const std::string& display, glm::ivec2 place, const std::vector<int>& colour) {
    const devices::Image8 picture = grabRoot(display);
    return picture.at(place.x, place.y, 0) == colour[0] && picture.at(place.x, place.y, 1) == colour[1] &&
           picture.at(place.x, place.y, 2) == colour[2];
  }
  void paintDesktop(const std::string& colour) { desktop_->x().query({"xsetroot", "-solid", colour}); }
  /// The first picture is there when the desktop's new colour is.
  void waitForPicture(glm::ivec2 place) {
    paintDesktop("#204060");
    ASSERT_TRUE(comesTrue([&] { return shows(place + glm::ivec2(5, 5), {0x20, 0x40, 0x60}); })) << log();
  }
  [[nodiscard]] std::string log() const { return textOf(folder_ / "log"); }
  [[nodiscard]] bool logHolds(const std::string& words) const { return log().find(words) != std::string::npos; }
  [[nodiscard]] std::filesystem::path wall() const { return folder_ / "wall"; }
  /// Of the desktop's pointer.
  [[nodiscard]] glm::ivec2 pointer() const {
    const std::string at = desktop_->x().query({"xdotool", "getmouselocation"});
    return {std::stoi(at.substr(2)), std::stoi(at.substr(at.find("y:") + 2))};
  }

  const TemporaryFolder folder_;
  XServer screen_{[](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "1400x700x24", "-nolisten", "tcp", "-noreset"};
  }};
  std::unique_ptr<XvncServer> desktop_;
  std::unique_ptr<Process> viewer_;
};

}  // namespace pixelflex::testing
