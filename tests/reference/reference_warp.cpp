#include "tests/reference/reference_warp.h"

#include <algorithm>
#include <cmath>

namespace pixelflex::reference {
namespace {

double kernelValue(double distance, Kernel kernel) {
  const double d = std::abs(distance);
  if (kernel == Kernel::kLinear) return std::max(0.0, 1.0 - d);
  // Keys 1981 with a = -0.5.
  if (d < 1) return 1.5 * d * d * d - 2.5 * d * d + 1;
  if (d < 2) return -0.5 * d * d * d + 2.5 * d * d - 4 * d + 2;
  return 0;
}

double decode(double code, bool linear) {
  if (linear) return code;
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double encode(double light, bool linear) {
  if (linear) return light;
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

std::array<double, 3> barycentric(const Triangle& triangle, glm::dvec2 p) {
  const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
  const auto& [a, b, c] = triangle.inProjector;
  const double whole = cross(b - a, c - a);
  return {cross(b - p, c - p) / whole, cross(c - p, a - p) / whole, cross(a - p, b - p) / whole};
}

}  // namespace

double sample(const devices::Image8& desktop, glm::dvec2 position, int channel, Kernel kernel) {
  const auto texel = [&](int x, int y) {
    return desktop.at(std::clamp(x, 0, desktop.width() - 1), std::clamp(y, 0, desktop.height() - 1), channel) / 255.0;
  };
  const int x = static_cast<int>(std::floor(position.x));
  const int y = static_cast<int>(std::floor(position.y));
  if (kernel == Kernel::kNearest) return texel(x, y);
  double sum = 0;
  for (int j = y - 3; j <= y + 3; ++j) {
    for (int i = x - 3; i <= x + 3; ++i) {
      sum += kernelValue(i + 0.5 - position.x, kernel) * kernelValue(j + 0.5 - position.y, kernel) * texel(i, j);
    }
  }
  return sum;
}

devices::Image<double> warp(const devices::Image8& desktop, const Job& job) {
  devices::Image<double> frame(job.resolution, 4);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const auto position = job.desktopFromProjector({x + 0.5, y + 0.5});
      if (!position) continue;
      frame.at(x, y, 3) = 1;
      for (int c = 0; c < 3; ++c) {
        const double code = std::clamp(sample(desktop, *position, c, job.kernel), 0.0, 1.0);
        const double light = decode(code, job.linearDesktop) * (job.alpha ? job.alpha(x, y) : 1.0);
        const double device = job.deviceCode ? job.deviceCode(light, c) : encode(light, job.linearDesktop);
        frame.at(x, y, c) = 255 * device;
      }
    }
  }
  return frame;
}

InverseMap mapOfTriangles(std::vector<Triangle> triangles, devices::Size desktop) {
  return [triangles = std::move(triangles), desktop](glm::dvec2 p) -> std::optional<glm::dvec2> {
    for (const auto& triangle : triangles) {
      const auto share = barycentric(triangle, p);
      if (*std::min_element(share.begin(), share.end()) < -1e-12) continue;
      glm::dvec3 weighted(0, 0, 0);
      for (std::size_t i = 0; i < 3; ++i) weighted += share[i] * triangle.weighted[i];
      const glm::dvec2 position(weighted.x / weighted.z, weighted.y / weighted.z);
      if (position.x < 0 || position.y < 0 || position.x > desktop.width || position.y > desktop.height) return {};
      return position;
    }
    return {};
  };
}

}  // namespace pixelflex::reference
