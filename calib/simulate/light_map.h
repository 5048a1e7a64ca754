#pragma once

#include <cstddef>
#include <vector>

#include "calib/simulate/light_image.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/raster_view.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Where a projector's light falls in a raster, computed once: for a lattice of raster points the projector pixel that
/// lights them and the radiance factor. Between lattice points both are interpolated (2e-4 projector pixels off at a
/// step of two).
class LightMap {
 public:
  /// `unit` (lumens per square millimetre) becomes radiance 1. An invisible projector gives an empty map.
  LightMap(const RasterView& view, const ProjectorLight& light, double unit, int step);

  /// The part of the raster that the light can reach, half-open.
  struct Box {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] devices::Size size() const { return {x1 - x0, y1 - y0}; }
    [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
  };
  [[nodiscard]] const Box& box() const { return box_; }

  /// Radiance of `image` averaged over every pixel of the box: three channels.
  [[nodiscard]] devices::ImageF render(const LightImage& image) const;
  /// Largest radiance factor within the frame; 0 if nothing is visible.
  [[nodiscard]] double brightest() const { return brightest_; }

 private:
  struct Node {
    float x = 0, y = 0;  // projector pixels
    float factor = -1;   // negative: no light comes here
  };
  void findBox(const RasterView& view, const ProjectorLight& light);
  void fillNodes(const RasterView& view, const ProjectorLight& light, double unit);
  void chooseSamples();
  [[nodiscard]] std::vector<Node> nodesAt(float rowInLattice) const;
  void renderRow(const LightImage& image, int y, float* out) const;
  void addSamples(const LightImage& image, const std::vector<Node>& nodes, float* out) const;

  Box box_;
  int step_;
  int columns_ = 0, rows_ = 0;
  int samples_ = 2;  // per raster pixel and axis
  double brightest_ = 0;
  std::vector<Node> nodes_;
};

}  // namespace pixelflex::calib
