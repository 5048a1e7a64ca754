#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "calib/simulate/simulated_wall.h"
#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// How wide the audience sees the display: what a degree of view means.
inline constexpr double kDisplayDegrees = 60;

/// A piece of a projector's true frame edge inside the display, about a degree long: points a view pixel apart.
struct BorderStretch {
  std::size_t projector = 0;
  std::vector<glm::dvec2> at;       // view pixels
  std::vector<glm::dvec2> outward;  // unit, away from the frame
};

/// A square of view pixels and the projectors that truly light it.
struct WallBlock {
  int x = 0, y = 0;           // of its first pixel
  int lit = 0;                // by so many projectors
  bool nearBorder = false;    // one of them, or another, ends here or close by
  std::uint64_t central = 0;  // bits of the projectors in the middle third of whose frame it lies
};
inline constexpr int kBlockPixels = 8;

/// A display looked at straight on, its border and overlaps known from the simulated optics alone.
class WallView {
 public:
  /// A pixel of the view is `scale` desktop pixels wide. The room must outlive this.
  WallView(const SimulatedWall& room, const Display& display, double scale);

  /// The light of the wall for eyes that blur by two desktop pixels (sigma): three channels.
  [[nodiscard]] devices::ImageF seen(const std::vector<devices::Image8>& frames) const;
  /// The same without eyes.
  [[nodiscard]] devices::ImageF light(const std::vector<devices::Image8>& frames) const;

  [[nodiscard]] double pixelsPerDegree() const { return size_.width / kDisplayDegrees; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] const std::vector<BorderStretch>& borders() const { return borders_; }
  [[nodiscard]] const std::vector<WallBlock>& blocks() const { return blocks_; }

 private:
  [[nodiscard]] glm::dvec2 viewFromWall(glm::dvec2 pointInWall) const;
  [[nodiscard]] glm::dvec2 wallFromView(glm::dvec2 pointInView) const;
  void findBorders(std::size_t projector);
  void addEdge(std::size_t projector, glm::dvec2 from, glm::dvec2 to);
  void findBlocks();
  [[nodiscard]] WallBlock blockAt(int x, int y) const;

  const SimulatedWall& room_;
  glm::dvec2 topLeft_, bottomRight_;  // wall
  double scale_;
  devices::Size size_;
  std::vector<BorderStretch> borders_;
  std::vector<WallBlock> blocks_;
};

inline constexpr double kRim = 8;
/// The display without kRim desktop pixels at its edge, where the picture ends on whole pixels of the projectors.
[[nodiscard]] Display withoutRim(const Display& display);

/// ITU-R BT.709.
[[nodiscard]] devices::ImageF luminanceOf(const devices::ImageF& light);

}  // namespace pixelflex::calib
