#pragma once

#include <array>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <stdexcept>
#include <vector>

#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::viewer {

/// A calibration that cannot be shown; what() says what is missing and what to run.
class PlanError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the store knows of one projector's light, in the form and meaning of OutputPlan's members.
struct ProjectorLight {
  glm::mat3 colour{1};
  devices::Image16 alpha;
  devices::Image16 gain;
  devices::Image16 black;
  glm::vec3 largestBlack{0};
  std::array<std::vector<float>, 3> inverseResponse;
};

/// Reads the files that the calibration names, relative to the wall's folder. Of an exact screen only the response is
/// read. Throws PlanError, StoreError, ImageError, ResponseError.
[[nodiscard]] ProjectorLight readLight(const std::filesystem::path& folder,
                                       const calib::ProjectorCalibration& projector);

}  // namespace pixelflex::viewer
