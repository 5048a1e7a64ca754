#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "calib/simulate/camera_fit.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/random.h"
#include "calib/simulate/rig.h"

namespace pixelflex::calib {

// What the generators of rigs have in common. Everything is drawn from the random numbers in a fixed order: a seed's
// rig must not change.

inline constexpr double kFrameWidth = 1300;  // mm on the wall
inline constexpr double kFrameOverlap = 0.2;

/// Decimal places that a person would write; keeps rig files readable.
[[nodiscard]] double decimals(double value, int places);
[[nodiscard]] glm::dvec3 decimals(glm::dvec3 value, int places);

/// A projector as it comes from the shop: everything but its pose.
[[nodiscard]] SimulatedProjectorSpec drawProjector(Random& random, devices::Size resolution, std::string name);

/// The part of the wall that a frame is meant for.
struct Place {
  glm::dvec2 target{0, 0};     // of the frame's middle, mm
  double width = kFrameWidth;  // of the frame, mm along the projector's own rows
  double roll = 0;             // degrees: 90 for a projector that stands on its side
};

/// How a projector is aimed by hand: turned by up to `slack` times the largest angles, a little off its target.
struct HandAim {
  glm::dvec3 turn{0, 0, 0};  // yaw, pitch and roll, degrees
  glm::dvec2 target{0, 0};   // mm on the wall
  double area = 0;           // that the frame covers, square mm
};
[[nodiscard]] HandAim drawAim(devices::Size resolution, const Place& place, double slack, Random& random);

/// The area on the wall that the frame's corners enclose.
[[nodiscard]] double litArea(const ProjectorLight& light);

/// Puts a projector where drawAim says, before a planar screen, at the distance where the frame has its area.
void aim(SimulatedProjectorSpec& spec, const Place& place, double slack, Random& random);

/// A projector where it is meant to be, but for `slack`; it gets the next name.
void addPlaced(Rig& rig, SimulatedProjectorSpec spec, const Place& place, double slack, Random& random);

/// p1, p2, …
[[nodiscard]] std::string nextName(const Rig& rig);

/// What all frames cover.
[[nodiscard]] WallBounds boundsOfFrames(const Rig& rig);
/// With the markers and a margin around.
[[nodiscard]] WallBounds boundsOfScreen(const Rig& rig);

/// Side of a marker that is about 58 pixels wide for a camera that sees `width` of the wall on so many pixels.
[[nodiscard]] double markerSide(double width, double cameraPixels);
/// The marker of the next id, its place and angle a little off.
void addMarker(Rig& rig, glm::dvec2 centre, double side, Random& random);
/// A row above and a row below the picture, `across` (at least two) each.
void addMarkerRows(Rig& rig, int across, double side, Random& random);

/// Makes a point of the wall its origin: markers and projectors move, the screen does not.
void moveOrigin(Rig& rig, glm::dvec2 origin);
/// Reaches a little beyond everything; its top-left corner becomes the wall's origin.
void addPlanarScreen(Rig& rig);

/// Four or six markers, a planar screen, and a camera that sees everything.
[[nodiscard]] Rig finished(Rig rig, Random& random);

}  // namespace pixelflex::calib
