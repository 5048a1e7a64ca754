#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "devices/display/event_loop.h"
#include "devices/display/window.h"
#include "devices/image/image.h"
#include "viewer/panel/panel_input.h"

namespace pixelflex::viewer {

/// The panel's window with its toolkit. Main thread, one at a time.
class PanelWindow {
 public:
  /// `scale` enlarges text and everything around it. `shortcut` hears every key first and returns whether it was one.
  /// Throws DisplayError.
  PanelWindow(devices::EventLoop& loop, const std::string& title, devices::Size size, float scale,
              std::function<bool(const devices::KeyStroke& stroke)> shortcut);
  ~PanelWindow();
  PanelWindow(const PanelWindow&) = delete;
  PanelWindow& operator=(const PanelWindow&) = delete;

  /// Shows a frame; `draw` says what is in it.
  void frame(const std::function<void()>& draw);
  /// Something has happened that the last frames do not show.
  [[nodiscard]] bool needsFrame() const;
  [[nodiscard]] bool closed() const { return closed_; }
  /// What the last frame shows.
  [[nodiscard]] devices::Image8 picture();

 private:
  /// The toolkit's own state.
  struct Toolkit {
    Toolkit();
    ~Toolkit();
    Toolkit(const Toolkit&) = delete;
    Toolkit& operator=(const Toolkit&) = delete;
  };
  void touch();
  void render();

  devices::Window window_;
  Toolkit toolkit_;
  std::function<bool(const devices::KeyStroke& stroke)> shortcut_;
  PanelInput input_;
  std::chrono::steady_clock::time_point drawn_;
  std::chrono::steady_clock::time_point touched_;
  bool rested_ = false;  // drawn once more, with hints, since the last input
  int framesLeft_ = 0;
  bool closed_ = false;
};

}  // namespace pixelflex::viewer
