#include "calib/report/light_figures.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "calib/photometric/colour_difference.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

/// The change over `reach` pixels to each side, of the value in the middle; 0 where one of them is not lit.
double changeAt(const ImageF& field, int x, int y, int reach) {
  if (x < reach || y < reach || x + reach >= field.width() || y + reach >= field.height()) return 0;
  const double left = field.at(x - reach, y);
  const double right = field.at(x + reach, y);
  const double above = field.at(x, y - reach);
  const double below = field.at(x, y + reach);
  const double here = field.at(x, y);
  if (std::min({left, right, above, below, here}) <= 0) return 0;
  return std::hypot(right - left, below - above) / here;
}

double steepest(const ImageF& field, double pixelsPerDegree) {
  const int reach = std::max(1, static_cast<int>(std::lround(pixelsPerDegree / 2)));
  double most = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) most = std::max(most, changeAt(field, x, y, reach));
  }
  return most * pixelsPerDegree / (2.0 * reach);
}

double difference(glm::dvec3 first, glm::dvec3 second, glm::dvec3 reference) {
  return deltaE2000(labFromLinearSrgb(first / reference), labFromLinearSrgb(second / reference));
}

glm::dvec3 ofLuminanceOne(glm::dvec3 colour) {
  return colour / luminanceOf(colour);
}

glm::dvec3 commonWhiteOf(std::span<const OwnColours> all) {
  glm::dvec3 sum(0);
  for (const auto& own : all) sum += own.white;
  return sum / static_cast<double>(all.size());
}

std::vector<OwnColours> coloursOfAll(const WallLight& light, Correction correction) {
  std::vector<OwnColours> all;
  for (const auto& projector : light.projectors) all.push_back(coloursOf(projector, correction));
  return all;
}

}  // namespace

Evenness evennessOf(const ImageF& field, double pixelsPerDegree) {
  double sum = 0, squares = 0, least = 1e300, most = 0, count = 0;
  for (const float value : field.samples()) {
    if (value <= 0) continue;
    sum += value, squares += static_cast<double>(value) * value, count += 1;
    least = std::min(least, static_cast<double>(value));
    most = std::max(most, static_cast<double>(value));
  }
  if (count == 0) return {};
  const double mean = sum / count;
  const double variance = std::max(0.0, squares / count - mean * mean);
  return {std::sqrt(variance) / mean, (most - least) / mean, steepest(field, pixelsPerDegree)};
}

glm::dvec3 meanLight(const ImageF& view) {
  glm::dvec3 sum(0);
  double count = 0;
  const auto samples = view.samples();
  for (std::size_t i = 0; i + 2 < samples.size(); i += 3) {
    const glm::dvec3 light(samples[i], samples[i + 1], samples[i + 2]);
    if (luminanceOf(light) > 0) sum += light, count += 1;
  }
  return count > 0 ? sum / count : sum;
}

OwnColours coloursOf(const PredictedProjector& projector, Correction correction) {
  FramePlace whole;  // the mean white, at full share, so that the gain's level does not matter
  whole.white = meanLight(projector.stored().white);
  const auto made = [&](const std::array<std::uint8_t, 3>& codes) {
    return projector.lightOf(whole, codes, correction) - projector.lightOf(whole, {0, 0, 0}, correction);
  };
  const glm::dvec3 white = made({255, 255, 255});
  OwnColours own{.white = ofLuminanceOne(white), .level = luminanceOf(whole.white)};
  own.primaries = {made({255, 0, 0}), made({0, 255, 0}), made({0, 0, 255})};
  for (auto& primary : own.primaries) primary /= luminanceOf(white);
  return own;
}

double whiteDifference(glm::dvec3 first, glm::dvec3 second, glm::dvec3 reference) {
  const glm::dvec3 a = first / reference;
  const glm::dvec3 b = second / reference;
  return difference(ofLuminanceOne(a), ofLuminanceOne(b), glm::dvec3(1));
}

glm::dvec3 commonWhite(const WallLight& light, Correction correction) {
  return commonWhiteOf(coloursOfAll(light, correction));
}

ColourFigures compareColours(const WallLight& light, Correction correction) {
  const auto all = coloursOfAll(light, correction);
  const glm::dvec3 reference = commonWhiteOf(all);
  double whites = 0, primaries = 0, pairs = 0;
  ColourFigures figures;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const double white = whiteDifference(all[i].white, all[j].white, reference);
      figures.whiteWorst = std::max(figures.whiteWorst, white);
      whites += white * white, pairs += 1;
      for (std::size_t c = 0; c < 3; ++c) {
        primaries += std::pow(difference(all[i].primaries.at(c), all[j].primaries.at(c), reference), 2);
      }
    }
  }
  if (pairs == 0) return figures;
  figures.whiteRms = std::sqrt(whites / pairs);
  const bool known = std::ranges::all_of(
      light.projectors, [](const PredictedProjector& projector) { return projector.stored().primaries.has_value(); });
  if (known) figures.primariesRms = std::sqrt(primaries / (3 * pairs));
  return figures;
}

}  // namespace pixelflex::calib
