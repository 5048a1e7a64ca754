#pragma once

#include <memory>
#include <string>

#include "devices/display/window.h"
#include "devices/projector/projector.h"

namespace pixelflex::devices {

/// A projector plugged into this machine: a borderless window of its resolution.
class WindowProjector final : public Projector {
 public:
  /// Black until something is shown. `at`: the window's corner on the display, a monitor's position for example.
  /// Throws DisplayError. The loop must outlive the projector.
  WindowProjector(std::string name, EventLoop& loop, Size resolution, glm::ivec2 at);
  ~WindowProjector() override;
  WindowProjector(const WindowProjector&) = delete;
  WindowProjector& operator=(const WindowProjector&) = delete;

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] Size resolution() const override { return resolution_; }

  /// Throws std::invalid_argument when the frame's size or channels are others.
  void show(const Image8& frame) override;
  void blank() override;

 private:
  void present();

  std::string name_;
  EventLoop& loop_;
  Size resolution_;
  Window window_;
  GlTexture picture_;
};

}  // namespace pixelflex::devices
