#include "tests/reference/reference_warp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// A picture of one channel stretched over the frame: samples at the centres of its pixels, straight between them.
double stretched(const devices::Image16& picture, glm::dvec2 share) {
  const glm::dvec2 at(share.x * picture.width(), share.y * picture.height());
  double sum = 0;
  for (int j = static_cast<int>(at.y) - 2; j <= static_cast<int>(at.y) + 2; ++j) {
    for (int i = static_cast<int>(at.x) - 2; i <= static_cast<int>(at.x) + 2; ++i) {
      const int x = std::clamp(i, 0, picture.width() - 1);
      const int y = std::clamp(j, 0, picture.height() - 1);
      const double weight = kernelValue(i + 0.5 - at.x, Kernel::kLinear) * kernelValue(j + 0.5 - at.y, Kernel::kLinear);
      sum += weight * picture.at(x, y) / 65535.0;
    }
  }
  return sum;
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

double sample(const devices::Image8& desktop, glm::dvec2 position, int channel, Kernel kernel, bool inLight) {
  const auto texel = [&](int x, int y) {
    const double code =
        desktop.at(std::clamp(x, 0, desktop.width() - 1), std::clamp(y, 0, desktop.height() - 1), channel) / 255.0;
    return inLight ? decode(code, false) : code;
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

namespace {

/// Light of the desktop at a position, channel by channel.
glm::dvec3 desktopLight(const devices::Image8& desktop, glm::dvec2 position, const Job& job) {
  glm::dvec3 light;
  for (int c = 0; c < 3; ++c) {
    const double value = std::clamp(sample(desktop, position, c, job.kernel, job.filterLight), 0.0, 1.0);
    light[c] = job.filterLight ? value : decode(value, job.linearDesktop);
  }
  return light;
}

double matchedLight(const glm::dvec3& light, int channel, int x, int y, const Job& job) {
  const auto row = static_cast<std::size_t>(3 * channel);
  double matched = job.colour[row] * light.x + job.colour[row + 1] * light.y + job.colour[row + 2] * light.z;
  if (job.alpha) matched *= job.alpha(x, y);
  if (!job.gain.empty()) {
    matched *= stretched(job.gain, {(x + 0.5) / job.resolution.width, (y + 0.5) / job.resolution.height});
  }
  if (job.black) matched += job.black(x, y)[channel];
  return std::clamp(matched, 0.0, 1.0);
}

}  // namespace

devices::Image<double> warp(const devices::Image8& desktop, const Job& job) {
  devices::Image<double> frame(job.resolution, 4);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const auto position = job.desktopFromProjector({x + 0.5, y + 0.5});
      if (!position) continue;
      frame.at(x, y, 3) = 1;
      const auto whole = desktopLight(desktop, *position, job);
      for (int c = 0; c < 3; ++c) {
        const double light = matchedLight(whole, c, x, y, job);
        const double device = job.deviceCode ? job.deviceCode(light, c) : encode(light, job.linearDesktop);
        frame.at(x, y, c) = job.highestCode * device;
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
