#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "devices/display/keysyms.h"
#include "viewer/model/model_view.h"

namespace pixelflex::viewer {

/// What the hand makes of the view: left drag turns, middle or right drag (or with Shift) moves, the wheel zooms, keys
/// fly and switch. Knows no windows.
class ModelNavigation {
 public:
  /// `span`: the desktop's shorter side, pixels: what a drag over it means.
  ModelNavigation(const ModelPose& start, bool wireframe, bool axes, std::optional<glm::dvec4> cut, double span);

  void button(int button, bool pressed);    // X numbers
  void pointer(glm::dvec2 pointInDesktop);  // also without a button
  void scroll(double steps);                // up positive
  void key(const devices::KeyStroke& stroke);

  /// Puts the parts that this owns into the view; true when one has changed since the last call.
  bool apply(ModelView& view);
  /// Escape, or Ctrl+Alt+Q.
  [[nodiscard]] bool quit() const { return quit_; }

 private:
  void press(std::uint32_t keysym);
  void toggleCut();

  ModelPose start_;
  ModelPose pose_;
  bool wireframe_;
  bool axes_;
  std::optional<glm::dvec4> cut_;  // as it was given
  std::optional<double> ownCut_;   // or the plane that faces the viewer: how far before the display, shorter sides
  double span_;
  std::optional<glm::dvec2> last_;
  int held_ = 0;  // button
  bool shift_ = false, control_ = false, alt_ = false;
  bool changed_ = true;
  bool quit_ = false;
};

}  // namespace pixelflex::viewer
