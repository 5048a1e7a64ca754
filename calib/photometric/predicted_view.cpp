#include "calib/photometric/predicted_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "calib/geometry/footprint.h"

namespace pixelflex::calib {
namespace {

using devices::Image16;
using devices::Image8;
using devices::ImageF;

/// Bilinear; samples stand in the middles of equal cells, beyond the outer ones the value is theirs.
template <class Sample>
double sampled(const devices::Image<Sample>& map, glm::dvec2 inFrame, int channel = 0) {
  const glm::dvec2 last(map.width() - 1, map.height() - 1);
  const glm::dvec2 p = glm::clamp(inFrame * glm::dvec2(map.width(), map.height()) - 0.5, glm::dvec2(0), last);
  const int x = static_cast<int>(p.x);
  const int y = static_cast<int>(p.y);
  const int right = std::min(x + 1, map.width() - 1);
  const int below = std::min(y + 1, map.height() - 1);
  const glm::dvec2 f = p - glm::dvec2(x, y);
  const double upper = map.at(x, y, channel) * (1 - f.x) + map.at(right, y, channel) * f.x;
  const double lower = map.at(x, below, channel) * (1 - f.x) + map.at(right, below, channel) * f.x;
  return upper * (1 - f.y) + lower * f.y;
}

double part(const Image16& map, glm::dvec2 inFrame, double whenEmpty, double full) {
  return map.empty() ? whenEmpty : sampled(map, inFrame) * full / 65535;
}

/// The primaries' share of the projector's white, channel by channel: each row sums to one.
Matrix3 relativeTo(const std::optional<Matrix3>& primaries) {
  if (!primaries) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Matrix3 relative = *primaries;
  for (std::size_t row = 0; row < 3; ++row) {
    const double white = relative.at(3 * row) + relative.at(3 * row + 1) + relative.at(3 * row + 2);
    for (std::size_t column = 0; column < 3; ++column) relative.at(3 * row + column) /= white;
  }
  return relative;
}

glm::dvec3 times(const Matrix3& m, glm::dvec3 v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

/// How much of a raster pixel around a point lies in the frame; `pitch`: projector pixels per raster pixel.
double coverageOf(glm::dvec2 p, devices::Size size, double pitch) {
  const auto inside = [&](double distance) { return std::clamp(distance / pitch + 0.5, 0.0, 1.0); };
  return inside(p.x) * inside(p.y) * inside(size.width - p.x) * inside(size.height - p.y);
}

std::array<std::uint8_t, 3> codesAt(const Image8& desktop, glm::dvec2 pointInDesktop) {
  const glm::dvec2 inFrame = pointInDesktop / glm::dvec2(desktop.width(), desktop.height());
  std::array<std::uint8_t, 3> codes{};
  for (int c = 0; c < 3; ++c) {
    codes[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(sampled(desktop, inFrame, c)));
  }
  return codes;
}

}  // namespace

double lightOfSrgb(std::uint8_t code) {
  const double value = code / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

PredictedProjector::PredictedProjector(StoredLight light, Transfer transfer)
    : light_(std::move(light)), leak_(light_.leak.value_or(0)), relative_(relativeTo(light_.primaries)) {
  assert(light_.white.channels() == 3);
  for (std::size_t code = 0; code < 256; ++code) {
    desktopLight_.at(code) =
        transfer == Transfer::kSrgb ? lightOfSrgb(static_cast<std::uint8_t>(code)) : static_cast<double>(code) / 255;
  }
}

FramePlace PredictedProjector::placeAt(glm::dvec2 inFrame) const {
  FramePlace place;
  for (int c = 0; c < 3; ++c) place.white[c] = sampled(light_.white, inFrame, c);
  place.share = part(light_.share, inFrame, 1, 1);
  place.gain = part(light_.gain, inFrame, 1, 1);
  const auto& largest = light_.largestLift;
  place.lift = part(light_.lift, inFrame, 0, 1) * glm::dvec3(largest[0], largest[1], largest[2]);
  return place;
}

glm::dvec3 PredictedProjector::ownLight(const FramePlace& place, const std::array<std::uint8_t, 3>& codes,
                                        Correction correction) const {
  glm::dvec3 light(0);
  for (glm::length_t c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const std::uint8_t code = codes.at(channel);
    const bool straight = correction != Correction::kNone;
    light[c] = straight          ? desktopLight_.at(code)
               : light_.response ? light_.response->light.at(channel).at(code)
                                 : lightOfSrgb(code);
  }
  if (correction == Correction::kNone) return light;
  if (correction == Correction::kShares) return place.share * light;
  const glm::dvec3 matched = place.share * place.gain * times(light_.colour, light) + place.lift;
  return glm::clamp(matched, glm::dvec3(0), glm::dvec3(1));
}

glm::dvec3 PredictedProjector::lightOf(const FramePlace& place, const std::array<std::uint8_t, 3>& codes,
                                       Correction correction) const {
  return place.white * (leak_ + times(relative_, ownLight(place, codes, correction)));
}

PredictedView::PredictedView(std::span<const PredictedProjector> projectors, std::span<const ProjectorMapping> mappings,
                             const WallRaster& raster)
    : projectors_(projectors), raster_(raster), spots_(projectors.size()) {
  assert(projectors.size() == mappings.size());
  for (std::size_t i = 0; i < projectors.size(); ++i) addSpots(i, mappings[i]);
}

void PredictedView::addSpots(std::size_t projector, const ProjectorMapping& mapping) {
  glm::dvec2 low(1e300);
  glm::dvec2 high(-1e300);
  for (const auto& point : footprint(mapping)) {
    low = glm::min(low, raster_.rasterFromWall(point));
    high = glm::max(high, raster_.rasterFromWall(point));
  }
  const glm::dvec2 last(raster_.size.width, raster_.size.height);
  const glm::ivec2 from(glm::clamp(glm::floor(low) - 1.0, glm::dvec2(0), last));
  const glm::ivec2 to(glm::clamp(glm::ceil(high) + 1.0, glm::dvec2(0), last));
  const devices::Size size = mapping.resolution();
  const double pitch = raster_.pitch * mapping.meanDensity();
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      const auto p = mapping.projectorFromWall(raster_.wallFromRaster({x + 0.5, y + 0.5}));
      if (!p) continue;
      const double coverage = coverageOf(*p, size, pitch);
      if (coverage <= 0) continue;
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.size.width) + static_cast<std::size_t>(x);
      const auto place = projectors_[projector].placeAt(*p / glm::dvec2(size.width, size.height));
      spots_[projector].push_back({pixel, coverage, place});
    }
  }
}

ImageF PredictedView::see(const Image8& desktop, Correction correction, std::span<const glm::dvec2> offsets) const {
  assert(desktop.size() == raster_.size && desktop.channels() == 3);
  assert(offsets.empty() || offsets.size() == spots_.size());
  ImageF view(raster_.size, 3);
  const auto codes = desktop.samples();
  const auto width = static_cast<std::size_t>(raster_.size.width);
  for (std::size_t i = 0; i < spots_.size(); ++i) {
    for (const auto& spot : spots_[i]) {
      std::array<std::uint8_t, 3> shown{codes[3 * spot.pixel], codes[3 * spot.pixel + 1], codes[3 * spot.pixel + 2]};
      if (!offsets.empty()) {
        const std::size_t row = spot.pixel / width;
        const glm::dvec2 middle(static_cast<double>(spot.pixel % width) + 0.5, static_cast<double>(row) + 0.5);
        shown = codesAt(desktop, middle - offsets[i]);
      }
      addLight(i, spot, shown, correction, view);
    }
  }
  return view;
}

ImageF PredictedView::seeField(const std::array<std::uint8_t, 3>& codes, Correction correction) const {
  ImageF view(raster_.size, 3);
  for (std::size_t i = 0; i < spots_.size(); ++i) {
    for (const auto& spot : spots_[i]) addLight(i, spot, codes, correction, view);
  }
  return view;
}

void PredictedView::addLight(std::size_t projector, const Spot& spot, const std::array<std::uint8_t, 3>& codes,
                             Correction correction, ImageF& view) const {
  const glm::dvec3 light = spot.coverage * projectors_[projector].lightOf(spot.place, codes, correction);
  for (int c = 0; c < 3; ++c) {
    view.samples()[3 * spot.pixel + static_cast<std::size_t>(c)] += static_cast<float>(light[c]);
  }
}

double luminanceOf(glm::dvec3 light) {
  return kCameraLuminance[0] * light.x + kCameraLuminance[1] * light.y + kCameraLuminance[2] * light.z;
}

ImageF luminanceOf(const ImageF& view) {
  assert(view.channels() == 3);
  ImageF luminance(view.size(), 1);
  const auto light = view.samples();
  for (std::size_t i = 0; i < luminance.samples().size(); ++i) {
    luminance.samples()[i] =
        static_cast<float>(luminanceOf(glm::dvec3(light[3 * i], light[3 * i + 1], light[3 * i + 2])));
  }
  return luminance;
}

}  // namespace pixelflex::calib
