#pragma once

#include <array>
#include <map>

#include "devices/image/image.h"
#include "tests/accuracy/shown_wall.h"
#include "tests/accuracy/wall_view.h"

namespace pixelflex::calib {

using Colour = std::array<int, 3>;  // sRGB codes

/// A wall that is shown in one way and looked at: every plain desktop is drawn and looked at once.
class SeenWall {
 public:
  /// The view must outlive this.
  SeenWall(Show show, devices::Size desktop, const WallView& view)
      : show_(std::move(show)), size_(desktop), view_(view) {}

  [[nodiscard]] const WallView& view() const { return view_; }
  /// What eyes see of a plain desktop: three channels.
  [[nodiscard]] const devices::ImageF& seen(const Colour& colour);
  [[nodiscard]] devices::ImageF luminance(int grey) { return luminanceOf(seen({grey, grey, grey})); }
  /// What the projectors show of it.
  [[nodiscard]] const std::vector<devices::Image8>& frames(const Colour& colour);

 private:
  Show show_;
  devices::Size size_;
  const WallView& view_;
  std::map<Colour, std::vector<devices::Image8>> frames_;
  std::map<Colour, devices::ImageF> seen_;
};

[[nodiscard]] devices::Image8 plainDesktop(devices::Size size, const Colour& colour);

}  // namespace pixelflex::calib
