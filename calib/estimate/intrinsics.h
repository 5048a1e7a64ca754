#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/store/calibration.h"
#include "calib/store/wall.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Measurements from which a model cannot be estimated; what() says which, and what to do.
class EstimateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The inner corners of the checkerboard in a photograph, row by row, raw pixels (centres at +0.5), to a tenth of a
/// pixel or better; none when the whole board is not seen.
[[nodiscard]] std::optional<std::vector<glm::dvec2>> findCheckerboard(const devices::Image8& photo,
                                                                      const Checkerboard& board);

/// One photograph's corners.
struct CheckerboardView {
  std::string name;  // for messages
  std::vector<glm::dvec2> corners;
};

/// Intrinsics and five distortion coefficients from several views (report 5.1.1). Views that fit more than three times
/// worse than the median are left out once, and so are repetitions of a view. Throws EstimateError when fewer than
/// three views remain or they do not determine the camera (all alike, never tilted), naming the photographs. `remarks`,
/// when given, gets what a person should know of a result that stands.
[[nodiscard]] CameraIntrinsics calibrateCamera(std::span<const CheckerboardView> views, const Checkerboard& board,
                                               devices::Size size, std::vector<std::string>* remarks = nullptr);

}  // namespace pixelflex::calib
