#include "calib/procedure/frame_border.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "calib/geometry/camera_mapping.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

constexpr int kPlacesOfSide = 24;
constexpr double kFirst = 0.08;                      // of a side: corners belong to two sides
constexpr std::array kDepths = {0.03, 0.04, 0.05};   // of the frame's larger extent, from the border
constexpr std::array kAlong = {-0.006, 0.0, 0.006};  // of the side
constexpr std::size_t kFewestPlaces = 12;
constexpr double kLargestDeviation = 0.15;  // of the leak
constexpr double kFaint = 3e-5;             // of white: less than this matters to nobody

/// From the frame to the camera's picture.
class Sight {
 public:
  Sight(const ProjectorMapping& projector, const ScreenView& view, const CameraIntrinsics& camera)
      : projector_(projector), view_(view), camera_(camera), size_(camera.size) {}

  [[nodiscard]] std::optional<glm::dvec2> wallFromFrame(glm::dvec2 inFrame) const {
    const auto [width, height] = projector_.resolution();
    return projector_.wallFromProjector({inFrame.x * width, inFrame.y * height});
  }

  /// The pixel; none outside of the picture.
  [[nodiscard]] std::optional<glm::ivec2> pixelFromWall(glm::dvec2 inWall) const {
    const glm::dvec2 raw = camera_.rawFromUndistorted(view_.imageFromWall(inWall));
    if (!(raw.x >= 0 && raw.y >= 0 && raw.x < size_.width && raw.y < size_.height)) return std::nullopt;
    return glm::ivec2(static_cast<int>(raw.x), static_cast<int>(raw.y));
  }

 private:
  const ProjectorMapping& projector_;
  const ScreenView& view_;
  CameraMapping camera_;
  devices::Size size_;
};

/// A point at `along` a side (0 top, 1 right, 2 bottom, 3 left) and `depth` of the larger extent inside of it.
glm::dvec2 pointAtSide(int side, double along, double depth, devices::Size frame) {
  const double longest = std::max(frame.width, frame.height);
  const glm::dvec2 step(depth * longest / frame.width, depth * longest / frame.height);
  switch (side) {
    case 0:
      return {along, step.y};
    case 1:
      return {1 - step.x, along};
    case 2:
      return {along, 1 - step.y};
    default:
      return {step.x, along};
  }
}

bool lights(const ProjectorMapping& projector, glm::dvec2 inWall) {
  const auto p = projector.projectorFromWall(inWall);
  return p && projector.insideFrame(*p);
}

std::array<double, 3> meanOf(const ImageF& picture, const std::vector<glm::ivec2>& pixels) {
  std::array<double, 3> sum{};
  for (const auto& p : pixels) {
    for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += picture.at(p.x, p.y, c);
  }
  for (double& value : sum) value /= static_cast<double>(pixels.size());
  return sum;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The mean of what lies near the median, which markers and edges of the screen do not move; none when too little does,
/// or when it varies too much to say.
std::optional<double> agreed(const std::vector<double>& ratios) {
  if (ratios.size() < kFewestPlaces) return std::nullopt;
  const double median = medianOf(ratios);
  std::vector<double> off;
  for (const double ratio : ratios) off.push_back(std::abs(ratio - median));
  const double spread = 1.48 * medianOf(off);
  double sum = 0;
  double count = 0;
  for (const double ratio : ratios) {
    if (std::abs(ratio - median) > 3 * spread + kFaint) continue;
    sum += ratio;
    ++count;
  }
  const double mean = std::max(0.0, sum / count);
  const double deviation = spread / std::sqrt(count);
  return deviation > kLargestDeviation * mean + kFaint ? std::nullopt : std::optional(mean);
}

}  // namespace

FrameBorder::FrameBorder(const ProjectorMapping& projector, const std::vector<ProjectorMapping>& others,
                         const ScreenView& view, const CameraIntrinsics& camera) {
  const Sight sight(projector, view, camera);
  const auto isOnlyBorder = [&](glm::dvec2 inside, glm::dvec2 outside) {
    return std::ranges::none_of(
        others, [&](const ProjectorMapping& other) { return lights(other, inside) != lights(other, outside); });
  };
  for (int k = 0; k < 4 * kPlacesOfSide; ++k) {
    const double middle = kFirst + (1 - 2 * kFirst) * (k % kPlacesOfSide + 0.5) / kPlacesOfSide;
    Place place;
    for (std::size_t sample = 0; sample < kDepths.size() * kAlong.size(); ++sample) {
      const double along = middle + kAlong.at(sample % kAlong.size());
      const double depth = kDepths.at(sample / kAlong.size());
      const auto inner = sight.wallFromFrame(pointAtSide(k / kPlacesOfSide, along, depth, projector.resolution()));
      const auto outer = sight.wallFromFrame(pointAtSide(k / kPlacesOfSide, along, -depth, projector.resolution()));
      if (!inner || !outer || !isOnlyBorder(*inner, *outer)) continue;
      const auto inside = sight.pixelFromWall(*inner);
      const auto outside = sight.pixelFromWall(*outer);
      if (!inside || !outside) continue;
      place.inside.push_back(*inside);
      place.outside.push_back(*outside);
    }
    if (place.inside.size() == kDepths.size() * kAlong.size()) places_.push_back(std::move(place));
  }
  region_ = {camera.size.width, camera.size.height, 0, 0};
  for (const auto& place : places_) {
    for (const auto* pixels : {&place.inside, &place.outside}) {
      for (const auto& p : *pixels) {
        region_ = {std::min(region_.left, p.x), std::min(region_.top, p.y), std::max(region_.right, p.x + 1),
                   std::max(region_.bottom, p.y + 1)};
      }
    }
  }
}

std::optional<double> FrameBorder::leak(const ImageF& black, const ImageF& white) const {
  std::vector<double> ratios;
  for (const auto& place : places_) {
    const auto blackInside = meanOf(black, place.inside);
    const auto blackOutside = meanOf(black, place.outside);
    const auto whiteInside = meanOf(white, place.inside);
    const auto whiteOutside = meanOf(white, place.outside);
    double ratio = 0;
    double channels = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double step = whiteInside.at(c) - whiteOutside.at(c);
      if (!(step > 0.5 * whiteInside.at(c))) continue;
      ratio += (blackInside.at(c) - blackOutside.at(c)) / step;
      ++channels;
    }
    if (channels > 0) ratios.push_back(ratio / channels);
  }
  return agreed(ratios);
}

}  // namespace pixelflex::calib
