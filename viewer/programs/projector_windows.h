#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/display/monitors.h"
#include "devices/display/window.h"
#include "viewer/programs/input.h"
#include "viewer/programs/view_options.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {

/// What wall.yaml says of a calibrated projector. Throws ViewError when it is not there any more.
[[nodiscard]] const calib::ProjectorConfig& configOf(const WallPlan& wall, const std::string& projector);

/// A borderless window for each projector that has an output, at its monitor or its place on the display. One whose
/// monitor is switched off waits, unseen, until the monitor is back; the others go on. Main thread.
class ProjectorWindows {
 public:
  /// Everything must outlive this. `share` has the frames.
  ProjectorWindows(devices::EventLoop& loop, const devices::Window& share, WallView& view, Input& input, int depth);

  /// Puts each window onto its monitor and shows all that have one, together; says which have come and gone.
  void follow(std::span<const devices::Monitor> monitors);
  /// Of these outputs; one window waits for its monitor's refresh, last, so that all change together.
  void present(std::span<const std::size_t> outputs);

  [[nodiscard]] bool empty() const { return windows_.empty(); }
  [[nodiscard]] bool anyShown() const;
  /// The X pointer going from window to window goes over the desktop without a jump.
  [[nodiscard]] bool lieAsOnTheWall() const;

 private:
  struct Projector {
    std::size_t output = 0;
    std::string name;
    calib::Output at;
    std::optional<glm::ivec2> flatAt;
    devices::Size resolution;
    std::unique_ptr<devices::Window> window;
    bool shown = false;
    bool missed = false;  // and it has been said
  };
  void open(std::size_t index, const devices::Window& share, Input& input, int depth);
  void place(Projector& projector, const devices::Monitor* monitor);
  void present(const Projector& projector);
  /// What the renderer has drawn last.
  void presentDrawn(const Projector& projector);
  void pace();

  devices::EventLoop& loop_;
  WallView& view_;
  std::vector<Projector> windows_;
};

}  // namespace pixelflex::viewer
