#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "calib/simulate/rig.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What a simulated projector and its mirror are set to, relative to how the rig has them.
struct ProjectorSetting {
  glm::dvec2 mirror{0, 0};  // degrees that the mirror has turned: right (pan) and up (tilt)
  double zoom = 0;          // these three: the way from the middle of the range, -1 to 1; 1 is the largest picture
  double focus = 0;
  glm::dvec2 shift{0, 0};  // of the lens: right and down
  bool lit = true;         // the lamp burns
  bool muted = false;
  bool frozen = false;
  double brightness = 0;                // added to every device code
  double contrast = 1;                  // times every device code
  std::array<double, 3> gain{1, 1, 1};  // times the codes of red, green and blue

  bool operator==(const ProjectorSetting&) const = default;
};

/// The projector as it throws its picture then. The rig's place is where the projector seems to be, seen in its mirror;
/// the mirror is mirrorDistance in front of that, folds the beam by a right angle from below, and turns about its
/// middle: panned by one degree the picture moves and rolls by one, tilted by one it moves by two. Only the place and
/// the optics change, and the lumens when the lamp is out.
[[nodiscard]] SimulatedProjectorSpec asSet(SimulatedProjectorSpec spec, const ProjectorSetting& setting);

/// A frame's codes after the projector's own picture settings.
[[nodiscard]] devices::Image8 asSet(devices::Image8 frame, const ProjectorSetting& setting);

}  // namespace pixelflex::calib
