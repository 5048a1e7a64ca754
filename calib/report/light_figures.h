#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/photometric/predicted_view.h"
#include "calib/report/wall_light.h"

namespace pixelflex::calib {

/// How even a field looks, of its lit pixels' luminance.
struct Evenness {
  double rms = 0;       // of the mean
  double range = 0;     // brightest minus darkest, of the mean
  double steepest = 0;  // change over a degree of view, of the luminance there
};
[[nodiscard]] Evenness evennessOf(const devices::ImageF& luminance, double pixelsPerDegree);

/// Mean over the pixels that are lit, channel by channel.
[[nodiscard]] glm::dvec3 meanLight(const devices::ImageF& view);

/// A projector's colours next to its white's luminance, in the camera's channels: columns of full red, green and blue.
struct OwnColours {
  glm::dvec3 white{1};
  std::array<glm::dvec3, 3> primaries{};
  double level = 0;  // mean luminance of its white over the frame
};
[[nodiscard]] OwnColours coloursOf(const PredictedProjector& projector, Correction correction);

/// Differences between any two projectors of a wall, CIEDE2000 at equal brightness.
struct ColourFigures {
  double whiteRms = 0, whiteWorst = 0;
  std::optional<double> primariesRms;  // where the primaries of all are known
};
[[nodiscard]] ColourFigures compareColours(const WallLight& light, Correction correction);

/// The difference of two whites at equal brightness where `reference` counts as neutral.
[[nodiscard]] double whiteDifference(glm::dvec3 first, glm::dvec3 second, glm::dvec3 reference);

/// The mean of the projectors' whites, each of luminance one.
[[nodiscard]] glm::dvec3 commonWhite(const WallLight& light, Correction correction);

}  // namespace pixelflex::calib
