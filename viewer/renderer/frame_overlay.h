#pragma once

#include <vector>

#include "devices/display/gl_handle.h"
#include "devices/image/image.h"
#include "viewer/renderer/warp_programs.h"
#include "viewer/tiles/region.h"

namespace pixelflex::viewer {

/// What is laid over a projector's frame, in its own pixels and without blending with its neighbours': a panel of text,
/// and borders of what was drawn lately, which fade. Needs its context current for setPanel() and draw().
class FrameOverlay {
 public:
  /// Four channels, not multiplied by alpha; empty: none. Adds what has to be drawn again to `stale`, here and below.
  void setPanel(const devices::Image8& panel, Region& stale);

  /// From here on note() keeps borders; without, those that are there go.
  void showDamage(bool shown, Region& stale);
  /// These parts are about to be drawn because of what changed on the desktop.
  void note(const Region& drawn, Region& stale);
  /// Makes the borders paler; after kSteps calls they are gone.
  void fade(Region& stale);
  [[nodiscard]] bool fading() const { return !borders_.empty(); }

  /// On top of a part that was just drawn. Leaves the scissor box changed.
  void draw(const Box& part, WarpPrograms& programs) const;

  static constexpr int kSteps = 5;

 private:
  struct Border {
    Box box;
    int stepsLeft = kSteps;
  };

  bool showsDamage_ = false;
  std::vector<Border> borders_;  // oldest first
  devices::GlTexture panel_;
  Box panelBox_;
};

}  // namespace pixelflex::viewer
