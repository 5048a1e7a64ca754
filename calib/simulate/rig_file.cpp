#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <set>

#include "calib/simulate/lens.h"
#include "calib/simulate/rig.h"
#include "calib/store/store_checks.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {

namespace {

using Node = YamlReader::Node;
using devices::Size;

constexpr int kMaxPoses = 200;
constexpr std::size_t kMaxMarkers = 50;
constexpr std::size_t kMaxPlaces = 64;
constexpr double kFarAway = 1e6;  // mm

void read(const Node& map, const char* key, double low, double high, double& value) {
  if (const Node node = map.optional(key); node.defined()) value = node.number(low, high);
}

void read(const Node& map, const char* key, int low, int high, int& value) {
  if (const Node node = map.optional(key); node.defined()) value = node.integer(low, high);
}

void read(const Node& map, const char* key, double low, double high, glm::dvec2& value) {
  const Node node = map.optional(key);
  if (!node.defined()) return;
  if (const auto numbers = node.numbers(2, low, high); numbers.size() == 2) value = {numbers[0], numbers[1]};
}

template <std::size_t Count>
void read(const Node& map, const char* key, double low, double high, std::array<double, Count>& values) {
  const Node node = map.optional(key);
  if (!node.defined()) return;
  if (const auto numbers = node.numbers(Count, low, high); numbers.size() == Count) {
    std::ranges::copy(numbers, values.begin());
  }
}

void read(const Node& map, const char* key, double low, double high, glm::dvec3& value) {
  std::array values{value.x, value.y, value.z};
  read(map, key, low, high, values);
  value = {values[0], values[1], values[2]};
}

/// A lens whose polynomial folds back within the frame would show some rays twice.
void checkLens(const Node& node, const Optics& optics, Size size) {
  if (optics.focal <= 0 || size.width <= 0 || size.height <= 0) return;  // noted already
  const Lens lens(optics);
  for (const double x : {0.0, 1.0 * size.width}) {
    for (const double y : {0.0, 1.0 * size.height}) {
      if (lens.rayFromPixel({x, y})) continue;
      node.problem("the lens distortion folds back before the frame's corner: use smaller radial coefficients");
      return;
    }
  }
}

/// The lens of a frame; without a word about it, a throw of 1.6 without shift.
Optics readOptics(const Node& node, Size size) {
  Optics optics;
  optics.focal = 1.6 * size.width;
  optics.principal = {0.5 * size.width, 0.5 * size.height};
  read(node, "focal", 0.1 * kMinResolution, 100.0 * kMaxResolution, optics.focal);
  read(node, "principal", -10.0 * kMaxResolution, 10.0 * kMaxResolution, optics.principal);
  read(node, "radial", -10, 10, optics.radial);
  read(node, "tangential", -1, 1, optics.tangential);
  checkLens(node, optics, size);
  return optics;
}

void readPlacement(const Node& node, Pose& pose) {
  read(node, "position", -kFarAway, kFarAway, pose.position);
  read(node, "rotation", -180, 180, pose.rotation);
  if (pose.position.z >= 0) node.problem("position: z must be negative, before the screen");
}

/// Straight before the screen's middle, where the frame just covers `part` of the screen's width.
Pose readPose(const Node& node, const Rig& rig, const Optics& optics, Size size, double part) {
  Pose pose;
  const glm::dvec2 middle = rig.screenTopLeft + 0.5 * rig.screenSize;
  pose.position = {middle.x, middle.y, -rig.screenSize.x * part * optics.focal / std::max(1, size.width)};
  readPlacement(node, pose);
  return pose;
}

Response readResponse(const Node& node) {
  Response response;
  read(node, "gamma", 0.3, 5, response.gamma);
  read(node, "gain", 0.01, 100, response.gain);
  read(node, "toe", 0, 0.1, response.toe);
  read(node, "black", 0, 0.5, response.black);
  node.refuseUnknownKeys();
  return response;
}

SimulatedProjectorSpec readProjector(const Node& node, const Rig& rig, std::size_t number) {
  SimulatedProjectorSpec spec;
  const Node name = node.optional("name");
  spec.name = name.defined() ? readName(name) : "p" + std::to_string(number);
  const Node resolution = node.optional("resolution");
  spec.resolution = resolution.defined() ? readSize(resolution, kMinResolution, kMaxResolution) : Size{1024, 768};
  spec.optics = readOptics(node, spec.resolution);
  spec.pose = readPose(node, rig, spec.optics, spec.resolution, 1);
  if (const Node response = node.optional("response"); response.defined()) spec.response = readResponse(response);
  read(node, "lumens", 0, 1e6, spec.lumens);
  read(node, "vignetting", 0, 1, spec.vignetting);
  read(node, "defocus", 0, 20, spec.defocus);
  read(node, "mirror_distance", 1, 1e5, spec.mirrorDistance);
  node.refuseUnknownKeys();
  return spec;
}

/// Further places; what one does not say is as at the first.
void readPlaces(const Node& list, Rig& rig) {
  for (const Node& node : list.elements(0, kMaxPlaces - 1)) {
    Pose place = rig.camera.pose;
    readPlacement(node, place);
    node.refuseUnknownKeys();
    rig.cameraPlaces.push_back(place);
  }
}

void readCamera(const Node& node, Rig& rig) {
  auto& camera = rig.camera;
  if (const Node size = node.optional("size"); size.defined())
    camera.size = readSize(size, kMinResolution, kMaxResolution);
  camera.optics = readOptics(node, camera.size);
  camera.pose = readPose(node, rig, camera.optics, camera.size, 1.1);
  read(node, "blur", 0, 2.5, camera.blur);
  read(node, "vignetting", 0, 1, camera.vignetting);
  read(node, "full_well", 1, 1e7, camera.fullWell);
  read(node, "read_noise", 0, 1e5, camera.readNoise);
  read(node, "gamma", 0.3, 5, camera.gamma);
  if (const Node places = node.optional("places"); places.defined()) readPlaces(places, rig);
  node.refuseUnknownKeys();
}

void readRoom(const Node& node, Room& room) {
  read(node, "dark", 0, 10, room.dark);
  read(node, "lit", 0, 1000, room.lit);
  read(node, "gradient", 0, 1, room.gradient);
  node.refuseUnknownKeys();
}

void readScreen(const Node& node, Rig& rig) {
  read(node, "top_left", -kFarAway, kFarAway, rig.screenTopLeft);
  read(node, "size", 1, kFarAway, rig.screenSize);
  read(node, "radius", -kFarAway, kFarAway, rig.screenRadius);
  const double widest = 2 * glm::radians(kLargestArcAngle) * std::abs(rig.screenRadius);
  if (rig.screenRadius != 0 && rig.screenSize.x > widest) {
    node.problem("radius: a screen of this width would reach further round than 160 degrees: use a larger radius");
  }
  node.refuseUnknownKeys();
}

void readCheckerboard(const Node& node, Rig& rig) {
  if (const Node list = node.optional("corners"); list.defined()) {
    const auto elements = list.elements(2, 2);
    if (elements.size() == 2) {
      rig.checkerboard.columns = elements[0].integer(2, 100);
      rig.checkerboard.rows = elements[1].integer(2, 100);
    }
  }
  read(node, "square", 0.1, 1e4, rig.checkerboard.square);
  read(node, "poses", 0, kMaxPoses, rig.checkerboardPoses);
  node.refuseUnknownKeys();
}

SimulatedMarker readMarker(const Node& node) {
  SimulatedMarker marker;
  read(node, "aruco", 0, kMaxArucoId, marker.aruco);
  read(node, "at", -kFarAway, kFarAway, marker.centre);
  read(node, "side", 1, 1e5, marker.side);
  read(node, "roll", -180, 180, marker.roll);
  node.refuseUnknownKeys();
  return marker;
}

void readMarkers(const Node& list, Rig& rig) {
  std::set<int> seen;
  for (const Node& node : list.elements(0, kMaxMarkers)) {
    rig.markers.push_back(readMarker(node));
    const int id = rig.markers.back().aruco;
    if (!seen.insert(id).second) node.problem("two markers have aruco id " + std::to_string(id));
  }
}

}  // namespace

Rig parseRig(std::string_view text, const std::string& file) {
  YamlReader reader(text, file);
  reader.readHeader("pixelflex-rig", kRigVersion);
  const Node root = reader.root();
  Rig rig;
  if (const Node node = root.optional("seed"); node.defined())
    rig.seed = static_cast<std::uint32_t>(node.number(0, 4294967295.0));
  if (const Node node = root.optional("screen"); node.defined()) readScreen(node, rig);
  if (const Node node = root.optional("room"); node.defined()) readRoom(node, rig.room);
  readCamera(root.optional("camera"), rig);
  if (const Node node = root.optional("checkerboard"); node.defined()) readCheckerboard(node, rig);
  if (const Node node = root.optional("markers"); node.defined()) readMarkers(node, rig);
  const Node projectors = root.required("projectors");
  for (const Node& node : projectors.elements(1, kMaxProjectors)) {
    rig.projectors.push_back(readProjector(node, rig, rig.projectors.size() + 1));
  }
  checkUniqueNames(projectors);
  root.refuseUnknownKeys();
  reader.throwIfProblems();
  return rig;
}

Rig loadRig(const std::filesystem::path& file) {
  return parseRig(readStoreFile(file.string()), file.string());
}

}  // namespace pixelflex::calib
