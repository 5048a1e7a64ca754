#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/simulate/simulated_wall.h"
#include "calib/store/calibration.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// RMS, 95th percentile and maximum of some errors, in projector pixels.
struct ErrorFigures {
  std::size_t count = 0;
  double rms = 0, p95 = 0, maximum = 0;
};
[[nodiscard]] ErrorFigures figuresOf(std::vector<double> errors);
[[nodiscard]] std::string text(const ErrorFigures& figures);

/// The contract's registration and seam error.
struct RegistrationFigures {
  std::vector<ErrorFigures> registration;  // per projector
  ErrorFigures all;
  ErrorFigures seam;  // over all pairs
};

/// The wall place that a calibration means a point of a projector's frame to light; none where it says nothing.
using MeantPlace = std::function<std::optional<glm::dvec2>(std::size_t projector, glm::dvec2 pointInProjector)>;

/// Errors at every third pixel both ways against the simulated optics alone. In pixels of the projector looked at, for
/// seams of the pair's first; or everywhere in pixels of the projector `unit` (which must light those places).
[[nodiscard]] RegistrationFigures measureRegistration(const SimulatedWall& room, const MeantPlace& meant,
                                                      std::optional<std::size_t> unit = std::nullopt);

/// The places that pictures of a coordinate desktop mean. `shown[i]`: what projector i really shows, four floats a
/// pixel, desktop x and y, and in the fourth whether the mesh is there. Keeps a reference to `shown`.
[[nodiscard]] MeantPlace meantByPictures(const Display& display, const std::vector<devices::ImageF>& shown);

}  // namespace pixelflex::calib
