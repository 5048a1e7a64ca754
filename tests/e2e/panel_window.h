#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/device_room.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {

/// The control panel in a window of an X server of its own, driven by xdotool, which finds its controls by their names;
/// the devices are simulated.
class PanelTest : public DeviceRoomTest {
 protected:
  struct Box {
    double x = 0, y = 0, width = 0, height = 0;
  };

  void startPanel(std::vector<std::string> more = {}, std::vector<std::string> environment = {}) {
    std::vector<std::string> command = {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-panel", folder(), "--controls",
                                        controlsFile()};
    command.insert(command.end(), more.begin(), more.end());
    environment.push_back("DISPLAY=" + screen_.display());
    panel_ = std::make_unique<Process>(command, ProcessOptions{.environment = environment, .log = folder_ / "log"});
  }

  /// As they are now.
  [[nodiscard]] std::map<std::string, Box> controls() const {
    std::map<std::string, Box> boxes;
    std::istringstream lines(textOf(controlsFile()));
    std::string name;
    Box box;
    while (lines >> name >> box.x >> box.y >> box.width >> box.height) boxes[name] = box;
    return boxes;
  }
  [[nodiscard]] bool has(const std::string& control) const { return controls().contains(control); }

  /// All is known about the chosen devices: nothing moves any more.
  void waitForSettings() const {
    for (const auto* control : {"set-pan", "set-power-on", "set-mute-on"}) (void)find(control);
  }

  /// At a part of its width, in its middle's height. Throws when it does not appear.
  void press(const std::string& control, double across = 0.5) const {
    const Box box = find(control);
    move(box.x + across * box.width, box.y + 0.5 * box.height);
    (void)screen_.query({"xdotool", "mousedown", "1", "mouseup", "1"});
  }
  void key(const std::string& name) const { (void)screen_.query({"xdotool", "key", name}); }
  void move(double x, double y) const {
    (void)screen_.query(
        {"xdotool", "mousemove", std::to_string(static_cast<int>(x)), std::to_string(static_cast<int>(y))});
  }
  [[nodiscard]] Box find(const std::string& control) const {
    if (comes([&] { return has(control); })) return controls().at(control);
    throw std::runtime_error("the panel has no " + control + ":\n" + textOf(controlsFile()) + log());
  }

  /// Within a generous time.
  [[nodiscard]] static bool comes(const std::function<bool()>& wanted) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!wanted()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  [[nodiscard]] std::string log() const { return textOf(folder_ / "log"); }
  [[nodiscard]] std::string controlsFile() const { return (folder_ / "controls").string(); }

  XServer screen_{[](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "2000x800x24", "-nolisten", "tcp", "-noreset"};
  }};
  std::unique_ptr<Process> panel_;
};

}  // namespace pixelflex::testing
