#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/wall.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// Right-handed room frame in millimetres: x right and y down along the wall as the audience sees it, z into the wall;
/// the planar screen is z = 0 and projectors and camera stand at z < 0. Wall coordinates are (x, y). A cylindrical
/// screen has a vertical axis and touches z = 0 in the middle of its width; wall coordinates are the unrolled screen,
/// its middle in the same place.
struct Pose {
  glm::dvec3 position{0, 0, 0};
  glm::dvec3 rotation{0, 0, 0};  // degrees: yaw about y, then pitch about x, then roll about the optical axis z
  bool operator==(const Pose&) const = default;
};

/// Pinhole with Brown distortion in the usual sense: a normalised ray is distorted, then scaled and shifted.
struct Optics {
  double focal = 0;            // pixels
  glm::dvec2 principal{0, 0};  // pixels from the top-left corner; off the middle is lens shift
  std::array<double, 3> radial{};
  std::array<double, 2> tangential{};
  bool operator==(const Optics&) const = default;
};

/// A power law with a toe and a clipped shoulder, per channel: light = white * response(code).
struct Response {
  std::array<double, 3> gamma{2.2, 2.2, 2.2};
  std::array<double, 3> gain{1, 1, 1};  // white balance: light at full code, relative
  double toe = 0.0;                     // 0..0.1: width of the flat foot, of full code
  double black = 0.002;                 // leak, of white
  bool operator==(const Response&) const = default;
};

struct SimulatedProjectorSpec {
  std::string name;
  devices::Size resolution;
  Pose pose;
  Optics optics;
  Response response;
  double lumens = 1500;         // sets radiance together with the lit area
  double vignetting = 0.3;      // 0..1: light lost in the frame's corners
  double defocus = 0.5;         // sigma of the blur, projector pixels
  double mirrorDistance = 200;  // mm from the place that the light seems to come from to the middle of the mirror
  bool operator==(const SimulatedProjectorSpec&) const = default;
};

struct SimulatedCameraSpec {
  devices::Size size{1920, 1080};
  Pose pose;
  Optics optics;
  double blur = 0.6;  // sigma of the point spread, camera pixels
  double vignetting = 0.2;
  double fullWell = 20000;  // electrons at full scale: sets the shot noise
  double readNoise = 6;     // electrons
  double gamma = 1.0;       // photographs are linear by default; 2.2 is a camera's JPEG
  bool operator==(const SimulatedCameraSpec&) const = default;
};

struct SimulatedMarker {
  int aruco = 0;
  glm::dvec2 centre{0, 0};  // wall coordinates
  double side = 120;        // of the black square, mm
  double roll = 0;          // degrees
  bool operator==(const SimulatedMarker&) const = default;
};

struct Room {
  double dark = 0.002;    // ambient light with the lights out, relative to a lit projector's typical white
  double lit = 0.35;      // with the lights on
  double gradient = 0.3;  // how uneven the room light is across the screen, 0..1
  bool operator==(const Room&) const = default;
};

/// Degrees: a cylindrical screen reaches no further than this to either side of its middle.
inline constexpr double kLargestArcAngle = 80;

/// The optics of a simulated wall: ground truth that no estimator may read.
struct Rig {
  std::uint32_t seed = 1;
  glm::dvec2 screenTopLeft{0, 0};
  glm::dvec2 screenSize{3000, 1500};  // wall units (mm); outside it is a dark surround
  double screenRadius = 0;            // 0: planar; positive: a cylinder hollow towards the audience, negative: bulging
  Room room;
  SimulatedCameraSpec camera;
  std::vector<Pose> cameraPlaces;  // where else the same camera is put, after camera.pose
  Checkerboard checkerboard;
  int checkerboardPoses = 15;
  std::vector<SimulatedMarker> markers;
  std::vector<SimulatedProjectorSpec> projectors;
  bool operator==(const Rig&) const = default;
};

inline constexpr int kRigVersion = 1;

/// format: pixelflex-rig. Throw StoreError with every problem.
[[nodiscard]] Rig parseRig(std::string_view text, const std::string& file);
[[nodiscard]] Rig loadRig(const std::filesystem::path& file);
[[nodiscard]] std::string formatRig(const Rig& rig);

/// The wall.yaml of somebody who owns this rig: names, resolutions, markers where they were measured, `sim` outputs and
/// camera, readings/NAME.csv for the gamma. `rigFile` is stored relative to the wall's folder.
[[nodiscard]] Wall wallOfRig(const Rig& rig, const std::string& rigFile);

/// 256 readings of a projector as a radiometer gives them: value,red,green,blue with a header row and 0.2 % noise.
[[nodiscard]] std::string readingsOfProjector(const SimulatedProjectorSpec& projector, std::uint32_t seed);

}  // namespace pixelflex::calib
