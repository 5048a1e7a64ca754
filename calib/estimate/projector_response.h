#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/estimate/exposure_merge.h"
#include "calib/estimate/intrinsics.h"
#include "calib/photometric/response_curve.h"

namespace pixelflex::calib {

/// A patch of the frame as the camera saw it while one channel showed `code` and the others 0.
struct LevelLight {
  int code = 0;
  PatchLight patch;
};

/// What is photographed to learn one projector's response, always the same patch.
struct ResponseSeries {
  std::array<std::vector<LevelLight>, 3> levels;  // red, green, blue: five codes or more, the last one 255; no code 0
  PatchLight black;                               // the projector shows code 0
  std::optional<PatchLight> ambient;              // it is dark, all else is as before
};

/// What is wrong with the photographs of one level.
class LevelError : public EstimateError {
 public:
  LevelError(int channel, int code, const std::string& problem)
      : EstimateError(problem), channel_(channel), code_(code) {}
  [[nodiscard]] int channel() const { return channel_; }
  [[nodiscard]] int code() const { return code_; }

 private:
  int channel_;
  int code_;
};

struct ProjectorResponse {
  ResponseCurve curve;
  /// Expected error relative to light with a floor of 1 % of white, RMS over codes 20 to 235, of noise and of the gaps
  /// between the levels; the camera's own error comes on top.
  std::array<double, 3> error{};
  std::optional<double> leak;  // black, ambient light taken off, over white above black; where ambient is known
};

/// Black and with it ambient light are subtracted, the camera's channels combined by how much they see of the
/// projector's, falls levelled, and the rest interpolated without overshoot. Throws LevelError: white no brighter than
/// black, clipped photographs, light that falls by more than noise does; EstimateError: missing levels.
[[nodiscard]] ProjectorResponse projectorResponse(const ResponseSeries& series);

}  // namespace pixelflex::calib
