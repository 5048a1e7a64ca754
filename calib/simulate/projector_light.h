#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "calib/simulate/placed_optics.h"
#include "calib/simulate/rig.h"

namespace pixelflex::calib {

/// Light of a channel per device code in 0..1, relative to a white of gain 1: toe, power, gain, and the leak of black.
[[nodiscard]] double channelLight(const Response& response, int channel, double code01);

/// How one projector lights the screen. Keeps references: the specification and the screen must outlive it.
class ProjectorLight {
 public:
  ProjectorLight(const SimulatedProjectorSpec& spec, const Screen& screen);

  [[nodiscard]] const SimulatedProjectorSpec& spec() const { return spec_; }
  [[nodiscard]] std::optional<glm::dvec2> wallFromPixel(glm::dvec2 pointInProjector) const;
  [[nodiscard]] std::optional<glm::dvec2> pixelFromWall(glm::dvec2 pointInWall) const;

  /// Lumens per square millimetre of the wall at full white of gain 1. The flux of a pixel spreads over the area that
  /// it covers, |d wall / d pixel|, which holds both distance and angle of incidence.
  [[nodiscard]] double illuminance(glm::dvec2 pointInWall) const;

  /// Mean and maximum of the illuminance over the frame; zero when the frame misses the screen.
  struct Level {
    double mean = 0;
    double maximum = 0;
  };
  [[nodiscard]] Level level() const;

 private:
  [[nodiscard]] double frameWeight(glm::dvec2 pointInProjector) const;

  const SimulatedProjectorSpec& spec_;
  const Screen& screen_;
  PlacedOptics optics_;
};

}  // namespace pixelflex::calib
