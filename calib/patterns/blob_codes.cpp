#include "calib/patterns/blob_codes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pixelflex::calib {
namespace {

using Points = std::vector<glm::dvec2>;

double median(std::vector<double> values, double whenNone) {
  if (values.empty()) return whenNone;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Displacements of points to partners within `reach` of where `guess` puts them.
Points displacements(const Points& from, const Points& to, glm::dvec2 guess, double reach) {
  Points found;
  for (const auto& point : from) {
    const auto nearest =
        std::ranges::min_element(to, {}, [&](const auto& other) { return glm::length(other + guess - point); });
    if (nearest != to.end() && glm::length(*nearest + guess - point) < reach) found.push_back(point - *nearest);
  }
  return found;
}

/// The displacement that most points share. The grid repeats itself every cell, so a displacement by one may suit more
/// points than none when some are hidden: none goes first.
glm::dvec2 commonShift(const Points& from, const Points& to, double cell) {
  constexpr int kSteps = 8;  // of a quarter cell, to each side
  const double reach = 0.2 * cell;
  glm::dvec2 best{0, 0};
  std::size_t most = displacements(from, to, best, reach).size();
  if (10 * most >= 3 * from.size()) return best;
  for (int y = -kSteps; y <= kSteps; ++y) {
    for (int x = -kSteps; x <= kSteps; ++x) {
      const glm::dvec2 guess = 0.25 * cell * glm::dvec2(x, y);
      const std::size_t count = displacements(from, to, guess, reach).size();
      if (count <= most) continue;
      most = count;
      best = guess;
    }
  }
  return best;
}

glm::dvec2 medianOf(const Points& points) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const auto& point : points) {
    xs.push_back(point.x);
    ys.push_back(point.y);
  }
  return {median(xs, 0), median(ys, 0)};
}

/// Another exposure is no reason to misread a code.
void normalise(CodePhoto& code) {
  constexpr double kLitShare = 0.15;  // at least so many blobs are lit in every code photograph
  if (code.ratio.empty()) return;
  std::vector<double> sorted = code.ratio;
  const auto lit = sorted.end() - 1 - static_cast<std::ptrdiff_t>(kLitShare * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), lit, sorted.end());
  if (*lit < 0.25) return;  // nothing is
  for (double& ratio : code.ratio) ratio /= *lit;
}

}  // namespace

CodePhoto readCode(const devices::ImageF& light, const devices::ImageF& blobsLight, const Spots& blobs,
                   const FrameLight& frame, double sigma) {
  CodePhoto code;
  const Spots own = findSpots(light, frame);
  code.spots = static_cast<int>(own.pointsInRaw.size());
  if (code.spots > 0) {
    const glm::dvec2 guess = commonShift(own.pointsInRaw, blobs.pointsInRaw, frame.cell());
    const Points moves = displacements(own.pointsInRaw, blobs.pointsInRaw, guess, 0.3 * frame.cell());
    code.shift = medianOf(moves);
    code.matched = static_cast<double>(moves.size()) / code.spots;
  }
  const int around = std::max(2, static_cast<int>(std::lround(2 * sigma)));
  std::vector<double> brightness;
  std::vector<double> sharpness;
  for (const auto& point : blobs.pointsInRaw) {
    const double all = std::max(1e-3, meanAround(blobsLight, point, 1));
    const double here = meanAround(light, point + code.shift, 1);
    code.ratio.push_back(here / all);
    if (here < 0.25 * all) continue;
    const double allAround = std::max(1e-3, meanAround(blobsLight, point, around));
    const double hereAround = std::max(1e-3, meanAround(light, point + code.shift, around));
    brightness.push_back(hereAround / allAround);
    sharpness.push_back(here / hereAround / (all / allAround));
  }
  normalise(code);
  code.brightness = median(brightness, 1);
  code.sharpness = median(sharpness, 1);
  return code;
}

}  // namespace pixelflex::calib
