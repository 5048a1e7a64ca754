#include <fmt/format.h>

#include <string_view>

#include "calib/simulate/rig.h"
#include "calib/store/yaml_text.h"

namespace pixelflex::calib {

namespace {

std::string pair(glm::dvec2 value) {
  return yamlList({value.x, value.y});
}

std::string triple(glm::dvec3 value) {
  return yamlList({value.x, value.y, value.z});
}

/// `indent` begins every line.
std::string formatPlace(const Pose& pose, const Optics& optics, std::string_view indent) {
  return fmt::format(
      "{0}position: {1}\n{0}rotation: {2}\n{0}focal: {3}\n{0}principal: {4}\n{0}radial: {5}\n{0}tangential: {6}\n",
      indent, triple(pose.position), triple(pose.rotation), yamlNumber(optics.focal), pair(optics.principal),
      yamlList(optics.radial), yamlList(optics.tangential));
}

/// Nothing for a camera that stays where it is.
std::string formatPlaces(const std::vector<Pose>& places) {
  std::string text = places.empty() ? "" : "  places:   # where else the same camera is put\n";
  for (const Pose& place : places) {
    text += fmt::format("    - {{position: {}, rotation: {}}}\n", triple(place.position), triple(place.rotation));
  }
  return text;
}

std::string formatScreen(const Rig& rig) {
  const std::string flat = "top_left: " + pair(rig.screenTopLeft) + ", size: " + pair(rig.screenSize);
  if (rig.screenRadius == 0) return "screen: {" + flat + "}\n";
  const std::string radius = yamlNumber(rig.screenRadius);
  return "screen: {" + flat + ", radius: " + radius + "}   # a cylinder that touches z = 0 in its middle; " +
         (rig.screenRadius > 0 ? "hollow" : "bulging") + " towards the audience\n";
}

std::string formatCamera(const SimulatedCameraSpec& camera) {
  return fmt::format("camera:   # blur in pixels (sigma), full_well and read_noise in electrons\n  size: [{}, {}]\n",
                     camera.size.width, camera.size.height) +
         formatPlace(camera.pose, camera.optics, "  ") +
         fmt::format("  blur: {}\n  vignetting: {}\n  full_well: {}\n  read_noise: {}\n  gamma: {}\n",
                     yamlNumber(camera.blur), yamlNumber(camera.vignetting), yamlNumber(camera.fullWell),
                     yamlNumber(camera.readNoise), yamlNumber(camera.gamma));
}

std::string formatMarker(const SimulatedMarker& marker) {
  return fmt::format("  - {{aruco: {}, at: {}, side: {}, roll: {}}}\n", marker.aruco, pair(marker.centre),
                     yamlNumber(marker.side), yamlNumber(marker.roll));
}

std::string formatProjector(const SimulatedProjectorSpec& spec) {
  const Response& response = spec.response;
  return fmt::format("  - name: {}\n    resolution: [{}, {}]\n", yamlText(spec.name), spec.resolution.width,
                     spec.resolution.height) +
         formatPlace(spec.pose, spec.optics, "    ") +
         fmt::format("    response: {{gamma: {}, gain: {}, toe: {}, black: {}}}\n", yamlList(response.gamma),
                     yamlList(response.gain), yamlNumber(response.toe), yamlNumber(response.black)) +
         fmt::format("    lumens: {}\n    vignetting: {}\n    defocus: {}\n", yamlNumber(spec.lumens),
                     yamlNumber(spec.vignetting), yamlNumber(spec.defocus)) +
         (spec.mirrorDistance == SimulatedProjectorSpec{}.mirrorDistance
              ? ""
              : fmt::format("    mirror_distance: {}\n", yamlNumber(spec.mirrorDistance)));
}

std::string formatStage(const Rig& rig) {
  return fmt::format(
      "format: pixelflex-rig\nversion: {}\n"
      "# The optics of a simulated wall. Millimetres and degrees; x right, y down, z into the wall, the screen at z = "
      "0.\n"
      "# Rotations are yaw, pitch, roll; focal length and principal point are in pixels, lenses Brown's.\n"
      "seed: {}\n{}"
      "room: {{dark: {}, lit: {}, gradient: {}}}   # ambient light, of a projector's typical white\n"
      "checkerboard: {{corners: [{}, {}], square: {}, poses: {}}}\n",
      kRigVersion, rig.seed, formatScreen(rig), yamlNumber(rig.room.dark), yamlNumber(rig.room.lit),
      yamlNumber(rig.room.gradient), rig.checkerboard.columns, rig.checkerboard.rows,
      yamlNumber(rig.checkerboard.square), rig.checkerboardPoses);
}

}  // namespace

std::string formatRig(const Rig& rig) {
  std::string text = formatStage(rig) + formatCamera(rig.camera) + formatPlaces(rig.cameraPlaces);
  text += rig.markers.empty() ? "markers: []\n" : "markers:\n";
  for (const auto& marker : rig.markers) text += formatMarker(marker);
  text += "projectors:\n";
  for (const auto& projector : rig.projectors) text += formatProjector(projector);
  return text;
}

}  // namespace pixelflex::calib
