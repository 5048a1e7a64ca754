#pragma once

#include "tests/e2e/view_screens.h"

namespace pixelflex::testing {

inline const std::vector<glm::ivec2> kAsOnTheWall{{100, 90}, {400, 90}, {700, 90}, {1000, 90}};

/// Four screens side by side, as on the wall, and what keys do on the desktop.
class DeskKeysTest : public ScreensTest {
 protected:
  void start(std::vector<std::string> more = {}) {
    makeWall(kAsOnTheWall);
    startViewer(std::move(more));
    waitForPicture(kAsOnTheWall[0]);
  }
  void key(const std::string& keys) { screen_.query({"xdotool", "key", "--delay", "30", keys}); }
  void moveTo(int x, int y) { screen_.query({"xdotool", "mousemove", std::to_string(x), std::to_string(y)}); }
  /// What the keys do on the desktop is in the log of this.
  void watchDesktopKeys() {
    keys_ = std::make_unique<Process>(
        std::vector<std::string>{"stdbuf", "-oL", "xev", "-geometry", "1200x200+0+0", "-event", "keyboard"},
        ProcessOptions{.environment = {"DISPLAY=" + desktop_->x().display()}, .log = folder_ / "keys"});
    desktop_->x().query({"xdotool", "search", "--sync", "--onlyvisible", "--name", "Event Tester"});
  }
  [[nodiscard]] std::size_t desktopHas(const std::string& words) const {
    const std::string text = textOf(folder_ / "keys");
    std::size_t count = 0;
    for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
    return count;
  }
  /// Works as soon as the viewer's window has the keyboard.
  void waitForKeys() {
    moveTo(250, 150);
    ASSERT_TRUE(comesTrue([&] {
      key("x");
      return desktopHas("keysym 0x78, x") > 0;
    })) << log();
  }
  std::unique_ptr<Process> keys_;
};

}  // namespace pixelflex::testing
