#include "calib/estimate/camera_transfer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "calib/estimate/exposure_merge.h"

namespace pixelflex::calib {
namespace {

constexpr double kLeastTolerance = 0.008;  // relative, RMS

/// Relative difference over the codes that count, scales apart, RMS, of the channel that differs most.
double difference(const CameraResponse& a, const CameraResponse& b) {
  constexpr double kCount = kBrightestCode - kDarkestCode + 1;
  double most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    double squares = 0;
    for (std::size_t code = kDarkestCode; code <= kBrightestCode; ++code) {
      if (!(a.light.at(c).at(code) > 0 && b.light.at(c).at(code) > 0)) return 1;
      const double off = std::log(a.light.at(c).at(code) / b.light.at(c).at(code));
      sum += off;
      squares += off * off;
    }
    most = std::max(most, std::sqrt(std::max(0.0, squares / kCount - sum * sum / (kCount * kCount))));
  }
  return most;
}

}  // namespace

CameraResponse srgbCamera() {
  CameraResponse camera;
  for (auto& light : camera.light) {
    for (std::size_t code = 0; code < 256; ++code) {
      const double v = static_cast<double>(code) / 255;
      light.at(code) = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
  }
  return camera;
}

CameraResponse nearestStandard(const CameraResponse& measured) {
  const double tolerance = std::max(kLeastTolerance, 2 * measured.error);
  for (CameraResponse standard : {linearCamera(), srgbCamera()}) {
    if (difference(measured, standard) > tolerance) continue;
    standard.error = measured.error;
    standard.residual = measured.residual;
    return standard;
  }
  return measured;
}

}  // namespace pixelflex::calib
