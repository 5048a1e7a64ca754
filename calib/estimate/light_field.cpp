#include "calib/estimate/light_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/estimate/smooth_field.h"
#include "calib/photometric/gamut.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

constexpr int kPerCell = 4;         // samples of a cell, both ways
constexpr double kClearOfEdge = 4;  // projector pixels: nearer to the border blur mixes in the dark
constexpr std::uint8_t kSaturated = 250;

using Colour = std::array<double, 3>;

/// White minus black around a point of the photographs, bilinear; false when saturated or outside.
bool addDifference(const Image8& black, const Image8& white, const CameraResponse& response, glm::dvec2 raw,
                   Colour& sum) {
  const glm::dvec2 p = raw - 0.5;
  const int x = static_cast<int>(std::floor(p.x));
  const int y = static_cast<int>(std::floor(p.y));
  if (x < 0 || y < 0 || x + 1 >= white.width() || y + 1 >= white.height()) return false;
  const glm::dvec2 f = p - glm::dvec2(x, y);
  for (int c = 0; c < 3; ++c) {
    const auto& light = response.light[static_cast<std::size_t>(c)];
    for (int k = 0; k < 4; ++k) {
      const int column = x + k % 2;
      const int row = y + k / 2;
      if (white.at(column, row, c) >= kSaturated) return false;
      const double weight = (k % 2 == 1 ? f.x : 1 - f.x) * (k / 2 == 1 ? f.y : 1 - f.y);
      const double difference = light.at(white.at(column, row, c)) - light.at(black.at(column, row, c));
      sum[static_cast<std::size_t>(c)] += 255 * weight * difference;
    }
  }
  return true;
}

class Sampler {
 public:
  Sampler(const Image8& black, const Image8& white, const ProjectorMapping& projector, const ScreenView& screen,
          const CameraMapping& camera, const CameraResponse& response)
      : black_(black), white_(white), projector_(projector), screen_(screen), camera_(camera), response_(response) {}

  [[nodiscard]] std::optional<glm::dvec2> rawFromProjector(glm::dvec2 p) const {
    const auto inWall = projector_.wallFromProjector(p);
    if (!inWall) return std::nullopt;
    return camera_.rawFromUndistorted(screen_.imageFromWall(*inWall));
  }

  /// Mean over a cell of the frame; zero when too little of it was seen.
  [[nodiscard]] Colour mean(glm::dvec2 corner, glm::dvec2 extent) const {
    Colour sum{};
    int seen = 0;
    const glm::dvec2 far(projector_.resolution().width - kClearOfEdge, projector_.resolution().height - kClearOfEdge);
    for (int k = 0; k < kPerCell * kPerCell; ++k) {
      const glm::dvec2 part(k % kPerCell + 0.5, static_cast<int>(k / kPerCell) + 0.5);
      const glm::dvec2 p = glm::clamp(corner + extent * part / double(kPerCell), glm::dvec2(kClearOfEdge), far);
      const auto raw = rawFromProjector(p);
      if (raw && addDifference(black_, white_, response_, *raw, sum)) ++seen;
    }
    for (double& channel : sum) channel = seen < kPerCell ? 0 : std::max(0.0, channel / seen);
    return sum;
  }

 private:
  const Image8& black_;
  const Image8& white_;
  const ProjectorMapping& projector_;
  const ScreenView& screen_;
  const CameraMapping& camera_;
  const CameraResponse& response_;
};

}  // namespace

glm::dvec2 LightField::inFrame(std::size_t node) const {
  const auto width = static_cast<std::size_t>(light.width());
  return {(static_cast<double>(node % width) + 0.5) / light.width(),
          (static_cast<double>(node / width) + 0.5) / light.height()};
}

LightField measureLight(const Image8& black, const Image8& white, const ProjectorMapping& projector,
                        const ScreenView& screen, const CameraMapping& camera, devices::Size lattice,
                        const CameraResponse& response) {
  LightField field{ImageF(lattice, 3), {}};
  const Sampler sampler(black, white, projector, screen, camera, response);
  const glm::dvec2 extent(double(projector.resolution().width) / lattice.width,
                          double(projector.resolution().height) / lattice.height);
  for (int y = 0; y < lattice.height; ++y) {
    for (int x = 0; x < lattice.width; ++x) {
      const glm::dvec2 corner = extent * glm::dvec2(x, y);
      const Colour mean = sampler.mean(corner, extent);
      for (int c = 0; c < 3; ++c) field.light.at(x, y, c) = static_cast<float>(mean[static_cast<std::size_t>(c)]);
      field.inCamera.push_back(sampler.rawFromProjector(corner + 0.5 * extent).value_or(glm::dvec2(-1)));
    }
  }
  return field;
}

std::vector<SeenLight> samplesOf(const LightField& field, std::size_t projector, const ProjectorMapping& mapping) {
  std::vector<SeenLight> samples;
  const devices::Size size = mapping.resolution();
  for (std::size_t node = 0; node < field.inCamera.size(); ++node) {
    const int x = static_cast<int>(node % static_cast<std::size_t>(field.light.width()));
    const int y = static_cast<int>(node / static_cast<std::size_t>(field.light.width()));
    double light = 0;
    for (int c = 0; c < 3; ++c) light += kCameraLuminance[static_cast<std::size_t>(c)] * field.light.at(x, y, c);
    const glm::dvec2 f = field.inFrame(node);
    const double density = mapping.density({f.x * size.width, f.y * size.height});
    const glm::dvec2 offMiddle =
        (2.0 * f - 1.0) * glm::dvec2(size.width, size.height) / glm::length(glm::dvec2(size.width, size.height));
    if (light > 0) samples.push_back({projector, field.inCamera[node], offMiddle, light, density});
  }
  return samples;
}

ImageF withoutVignetting(const LightField& field, const CameraVignetting& vignetting) {
  ImageF corrected(field.light.size(), 3);
  for (std::size_t node = 0; node < field.inCamera.size(); ++node) {
    const int x = static_cast<int>(node % static_cast<std::size_t>(field.light.width()));
    const int y = static_cast<int>(node / static_cast<std::size_t>(field.light.width()));
    const double passed = vignetting.transmission(field.inCamera[node]);
    for (int c = 0; c < 3; ++c) corrected.at(x, y, c) = static_cast<float>(field.light.at(x, y, c) / passed);
  }
  return smoothField(corrected);
}

}  // namespace pixelflex::calib
