#include "calib/estimate/fiducial_model.h"

#include <cmath>
#include <numbers>

namespace pixelflex::calib {

SmoothMarker::SmoothMarker(const MarkerModules& modules) {
  for (auto& row : white_) row.fill(1);
  for (std::size_t y = 1; y + 1 < kColumns; ++y) {
    for (std::size_t x = 1; x + 1 < kColumns; ++x) {
      const bool inner = x > 1 && x < 6 && y > 1 && y < 6;
      white_[y][x] = inner && modules[(y - 2) * 4 + x - 2] ? 1 : 0;
    }
  }
}

SmoothMarker::Value SmoothMarker::at(glm::dvec2 p, glm::dvec2 sigma) const {
  const Weights x = weightsAt(6 * p.x + 1, 6 * sigma.x);
  const Weights y = weightsAt(6 * p.y + 1, 6 * sigma.y);
  Value value{0, 0, 0};
  for (std::size_t j = 0; j < kColumns; ++j) {
    double line = 0;
    double slope = 0;
    for (std::size_t i = 0; i < kColumns; ++i) {
      line += white_[j][i] * x.share[i];
      slope += white_[j][i] * x.slope[i];
    }
    value.white += line * y.share[j];
    value.byX += 6 * slope * y.share[j];
    value.byY += 6 * line * y.slope[j];
  }
  return value;
}

SmoothMarker::Weights SmoothMarker::weightsAt(double at, double sigma) {
  Weights weights;
  double step = 1;  // the outermost columns go on for ever
  double bell = 0;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const bool last = i + 1 == kColumns;
    const double t = (at - (static_cast<double>(i) + 1)) / sigma;
    const double nextStep = last ? 0 : 0.5 * (1 + std::erf(t / std::numbers::sqrt2));
    const double nextBell = last ? 0 : std::exp(-0.5 * t * t) / (sigma * std::sqrt(2 * std::numbers::pi));
    weights.share[i] = step - nextStep;
    weights.slope[i] = bell - nextBell;
    step = nextStep;
    bell = nextBell;
  }
  return weights;
}

}  // namespace pixelflex::calib
