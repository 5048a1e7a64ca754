#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/wall_raster.h"

namespace pixelflex::calib {

/// Four projectors, two by two with broad overlaps and a little turned, with their light known exactly.
class LitWall {
 public:
  static constexpr devices::Size kFrame{400, 300};
  static constexpr double kPitch = 4;

  struct Truth {
    double white, vignetting, leak;
  };
  std::vector<Truth> truth{{1.0, 0.2, 0.002}, {0.86, 0.35, 0.004}, {1.12, 0.25, 0.001}, {0.95, 0.4, 0.003}};
  std::vector<ProjectorMapping> mappings;
  WallRaster raster{{16, 16}, kPitch, {172, 124}};  // the display area: 16..704 x 16..512

  LitWall() {
    const std::vector<glm::dvec2> corners = {{0, 0}, {320, 3}, {-3, 232}, {324, 228}};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const double turn = 0.008 * (i % 2 == 0 ? 1 : -1);
      const auto p = corners[i];
      mappings.emplace_back(
          ProjectorModel{.projectorFromWall = {1, turn, -p.x - turn * p.y, -turn, 1, turn * p.x - p.y, 1e-6, 2e-6, 1},
                         .centre = {0, 0},
                         .scale = 1},
          kFrame);
    }
  }

  /// Luminance of full white above black at a wall point; 0 outside the frame.
  [[nodiscard]] double whiteAt(std::size_t i, glm::dvec2 pointInWall) const {
    const auto p = mappings[i].projectorFromWall(pointInWall);
    if (!p || !mappings[i].insideFrame(*p)) return 0;
    const double x = (p->x - 200) / 250;
    const double y = (p->y - 150) / 250;
    return truth[i].white * (1 - truth[i].vignetting * (x * x + y * y));
  }
  [[nodiscard]] double blackAt(std::size_t i, glm::dvec2 pointInWall) const {
    return truth[i].leak * whiteAt(i, pointInWall);
  }
  [[nodiscard]] double shareAt(std::size_t i, glm::dvec2 pointInWall) const {
    double sum = 0;
    for (std::size_t k = 0; k < mappings.size(); ++k) sum += weightAt(k, pointInWall);
    return sum > 0 ? weightAt(i, pointInWall) / sum : 0;
  }

  [[nodiscard]] std::vector<ProjectorLightMaps> maps() const {
    std::vector<ProjectorLightMaps> all;
    for (std::size_t i = 0; i < mappings.size(); ++i) {
      all.push_back({draw([&](glm::dvec2 p) { return whiteAt(i, p); }),
                     draw([&](glm::dvec2 p) { return blackAt(i, p); }),
                     draw([&](glm::dvec2 p) { return shareAt(i, p); })});
    }
    return all;
  }

  template <class Field>
  [[nodiscard]] devices::ImageF draw(const Field& field) const {
    devices::ImageF image(raster.size, 1);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        image.at(x, y) = static_cast<float>(field(raster.wallFromRaster({x + 0.5, y + 0.5})));
      }
    }
    return image;
  }

 private:
  [[nodiscard]] double weightAt(std::size_t i, glm::dvec2 pointInWall) const {
    const auto p = mappings[i].projectorFromWall(pointInWall);
    if (!p) return 0;
    const auto step = [](double distance) {
      const double t = std::clamp(distance / 70, 0.0, 1.0);
      return t * t * (3 - 2 * t);
    };
    return step(p->x) * step(kFrame.width - p->x) * step(p->y) * step(kFrame.height - p->y);
  }
};

}  // namespace pixelflex::calib
