#pragma once

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

/// The contract's registration and seam error. `shown[i]`: what projector i really shows, a desktop of its own
/// coordinates drawn by the renderer: four floats a pixel, desktop x and y, and in the fourth whether the mesh is
/// there. Ground truth comes from the simulated optics alone.
struct RegistrationFigures {
  std::vector<ErrorFigures> registration;  // per projector
  ErrorFigures all;
  ErrorFigures seam;  // over all pairs
};
[[nodiscard]] RegistrationFigures measureRegistration(const SimulatedWall& room, const Display& display,
                                                      const std::vector<devices::ImageF>& shown);

}  // namespace pixelflex::calib
