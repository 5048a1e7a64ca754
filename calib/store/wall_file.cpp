#include <algorithm>

#include "calib/store/store.h"
#include "calib/store/store_checks.h"
#include "calib/store/wall_requests.h"
#include "calib/store/yaml_document.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

using Node = YamlReader::Node;

constexpr double kTiny = 1e-6;
constexpr double kHuge = 1e9;

Fiducial readFiducial(const Node& node) {
  Fiducial fiducial;
  const Node aruco = node.optional("aruco");
  const Node camera = node.optional("camera");
  if (node.isMap() && aruco.defined() == camera.defined()) {
    node.problem(R"(a fiducial has either "aruco: ID" or "camera: [x, y]")");
  }
  if (aruco.defined()) fiducial.aruco = aruco.integer(0, kMaxArucoId);
  if (camera.defined()) fiducial.pointInCamera = readPoint(camera);
  fiducial.pointInWall = readPoint(node.required("at"));
  node.refuseUnknownKeys();
  return fiducial;
}

void readShape(const Node& node, Surface& surface) {
  if (node.isMap()) {
    const Node cylinder = node.required("cylinder");
    surface.shape = SurfaceShape::kCylinder;
    surface.cylinderRadius = cylinder.required("radius").number(kTiny, kHuge);
    cylinder.refuseUnknownKeys();
    return node.refuseUnknownKeys();
  }
  const std::string shape = node.defined() ? node.text() : "planar";
  if (shape == "camera") surface.shape = SurfaceShape::kCamera;
  if (shape != "camera" && shape != "planar") {
    node.problem("expected planar, camera or {cylinder: {radius: R}}, found " + quotedForMessage(shape));
  }
}

Surface readSurface(const Node& node) {
  Surface surface;
  readShape(node.optional("shape"), surface);
  if (const Node units = node.optional("units"); units.defined()) surface.units = readText(units, kMaxName);
  if (const Node fiducials = node.optional("fiducials"); fiducials.defined()) {
    for (const Node& fiducial : fiducials.elements(0, kMaxFiducials)) {
      surface.fiducials.push_back(readFiducial(fiducial));
    }
  }
  node.refuseUnknownKeys();
  return surface;
}

Checkerboard readCheckerboard(const Node& node) {
  Checkerboard board;
  const Node corners = node.required("corners");
  const auto counts = corners.elements(2, 2);
  if (counts.size() == 2) {
    board.columns = counts[0].integer(3, 64);
    board.rows = counts[1].integer(3, 64);
  }
  board.square = node.required("square").number(kTiny, kHuge);
  node.refuseUnknownKeys();
  return board;
}

bool isCameraSource(const std::string& source) {
  const auto has = [&](std::string_view prefix) { return source.starts_with(prefix) && source.size() > prefix.size(); };
  return source == "photos" || source == "sim" || source == "none" || has("v4l2:") || has("aravis:") || has("gphoto2:");
}

CameraSource readCamera(const Node& node) {
  CameraSource camera;
  const Node source = node.required("source");
  if (source.defined()) camera.source = readText(source, kMaxPath);
  if (!isCameraSource(camera.source)) {
    source.problem("expected photos, sim, none, v4l2:DEVICE, aravis:NAME or gphoto2:NAME, found " +
                   quotedForMessage(camera.source));
  }
  if (const Node board = node.optional("checkerboard"); board.defined()) camera.checkerboard = readCheckerboard(board);
  if (const Node latency = node.optional("latency"); latency.defined()) camera.latency = latency.number(0, 10);
  if (const Node transfer = node.optional("transfer"); transfer.defined()) camera.transfer = readTransfer(transfer);
  node.refuseUnknownKeys();
  return camera;
}

Output readOutputMap(const Node& node) {
  Output output;
  const Node monitor = node.optional("monitor");
  const Node display = node.optional("display");
  const Node at = node.optional("at");
  if (monitor.defined() == display.defined() || at.defined() != display.defined()) {
    node.problem(R"(expected sim, none, {monitor: NAME} or {display: ":0", at: [x, y]})");
  }
  if (monitor.defined()) {
    output.kind = OutputKind::kMonitor;
    output.monitor = readText(monitor, kMaxName);
  }
  if (display.defined()) {
    output.kind = OutputKind::kDisplay;
    output.display = readText(display, kMaxName);
    output.at = readPixel(at, -kMaxExtent, kMaxExtent);
  }
  node.refuseUnknownKeys();
  return output;
}

Output readOutput(const Node& node) {
  if (!node.defined()) return {};
  if (node.isMap()) return readOutputMap(node);
  const std::string kind = node.isScalar() ? node.text() : "";
  if (kind != "sim" && kind != "none") {
    node.problem(R"(expected sim, none, {monitor: NAME} or {display: ":0", at: [x, y]})");
  }
  Output output;
  if (kind == "sim") output.kind = OutputKind::kSim;
  return output;
}

std::optional<DeviceLine> readDevice(const Node& node) {
  if (!node.defined()) return std::nullopt;
  DeviceLine line{readText(node.required("driver"), kMaxName), readText(node.required("at"), kMaxPath), {}};
  if (const Node file = node.optional("password_file"); file.defined()) line.passwordFile = readText(file, kMaxPath);
  node.refuseUnknownKeys();
  return line;
}

ProjectorConfig readProjector(const Node& node) {
  ProjectorConfig projector;
  projector.name = readName(node.required("name"));
  projector.resolution = readSize(node.required("resolution"), kMinResolution, kMaxResolution);
  projector.output = readOutput(node.optional("output"));
  if (const Node gamma = node.optional("gamma"); gamma.defined()) {
    const std::string text = readText(gamma, kMaxPath);
    projector.gammaByCamera = text == "camera";
    if (!projector.gammaByCamera) projector.gamma = text;
  }
  projector.control = readDevice(node.optional("control"));
  projector.mirror = readDevice(node.optional("mirror"));
  projector.flatAt = readFlat(node.optional("flat"), projector.resolution);
  node.refuseUnknownKeys();
  return projector;
}

void checkFiducials(const Node& root, const Wall& wall) {
  const auto& surface = wall.surface;
  if (wall.isFlat() || wall.camera.source == "none" || surface.shape == SurfaceShape::kCamera) return;
  const Node list = root.optional("surface").optional("fiducials");
  const Node place = list.defined() ? list : root;
  const std::size_t count = surface.fiducials.size();
  if (count < 4) {
    place.problem("fewer than four fiducials: the collineation needs at least four");
  } else if (surface.shape == SurfaceShape::kCylinder && count < 6) {
    place.problem("fewer than six fiducials: a cylinder needs at least six");
  } else if (leavesCollineationOpen(surface.fiducials)) {
    place.problem("all fiducials, or all but one, lie on one line: the collineation needs four corners of an area");
  }
}

/// Whether all markers and places differ; notes those that do not.
bool checkDuplicates(const Node& list, const std::vector<Fiducial>& fiducials) {
  bool different = true;
  for (std::size_t i = 0; i < fiducials.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = fiducials[i];
      const auto& b = fiducials[j];
      const bool sameMarker = a.aruco ? a.aruco == b.aruco : a.pointInCamera && a.pointInCamera == b.pointInCamera;
      if (sameMarker) list.at(i).problem("this marker is listed twice");
      const bool samePlace = a.pointInWall == b.pointInWall;
      if (samePlace) list.at(i).problem("another fiducial is at the same place on the wall");
      different = different && !sameMarker && !samePlace;
    }
  }
  return different;
}

void checkSimulation(const Node& root, const Wall& wall) {
  if (wall.rig) return;
  const bool outputs = std::ranges::any_of(
      wall.projectors, [](const ProjectorConfig& projector) { return projector.output.kind == OutputKind::kSim; });
  if (wall.camera.source == "sim" || outputs) root.problem("something is simulated (sim), so \"rig: FILE\" is needed");
}

void checkFlat(const Node& projectors, const Wall& wall) {
  if (wall.isFlat()) return;
  for (std::size_t i = 0; i < wall.projectors.size(); ++i) {
    if (wall.projectors[i].flatAt) {
      projectors.at(i).problem(R"(this screen has "flat", others have not: either all or none)");
    }
  }
}

void migrate(YamlReader& reader, int version) {
  if (version < 1) reader.moveMember("blend_exponent", "blend.density_exponent");
  if (version < 1) reader.moveMember("screen", "surface");
}

/// Everything but the surface.
void readRest(const Node& root, Wall& wall) {
  if (const Node node = root.optional("camera"); node.defined()) wall.camera = readCamera(node);
  const Node projectors = root.required("projectors");
  for (const Node& node : projectors.elements(1, kMaxProjectors)) wall.projectors.push_back(readProjector(node));
  if (const Node node = root.optional("blend"); node.defined()) wall.blend = readBlend(node);
  if (const Node node = root.optional("display"); node.defined()) wall.display = readDisplay(node);
  if (const Node node = root.optional("desktop"); node.defined()) wall.desktop = readDesktop(node);
  wall.transfer = readTransfer(root.optional("transfer"));
  if (const Node node = root.optional("rig"); node.defined()) wall.rig = readText(node, kMaxPath);
}

/// What concerns several members, each of which is in order.
void checkSurface(const Node& root, const Wall& wall) {
  const Node list = root.optional("surface").optional("fiducials");
  if (checkDuplicates(list, wall.surface.fiducials)) checkFiducials(root, wall);
}

}  // namespace

Wall parseWall(std::string_view text, const std::string& file) {
  YamlReader reader(text, file);
  migrate(reader, reader.readHeader("pixelflex-wall", kWallVersion));
  const Node root = reader.root();
  Wall wall;
  const std::size_t before = reader.problems().size();
  if (const Node node = root.optional("surface"); node.defined()) wall.surface = readSurface(node);
  const bool surfaceIsSound = reader.problems().size() == before;
  readRest(root, wall);
  root.refuseUnknownKeys();
  if (surfaceIsSound) checkSurface(root, wall);
  const Node projectors = root.optional("projectors");
  checkUniqueNames(projectors);
  checkFlat(projectors, wall);
  checkSimulation(root, wall);
  reader.throwIfProblems();
  return wall;
}

}  // namespace pixelflex::calib
