#include <algorithm>
#include <cmath>

#include "calib/store/store.h"
#include "calib/store/store_checks.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

using Node = YamlReader::Node;

constexpr double kTiny = 1e-12;
constexpr double kHuge = 1e12;
constexpr std::size_t kMaxSamples = 1'000'000;

template <std::size_t count>
std::array<double, count> readArray(const Node& node) {
  std::array<double, count> values{};
  std::ranges::copy(node.numbers(count, -kHuge, kHuge), values.begin());
  return values;
}

/// A collineation: nine numbers, row major, with an inverse.
std::array<double, 9> readCollineation(const Node& node) {
  const auto m = readArray<9>(node);
  const double determinant =
      m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
  if (!(std::abs(determinant) > 0)) node.problem("this matrix is singular: it maps an area to a line");
  return m;
}

CameraIntrinsics readCamera(const Node& node) {
  CameraIntrinsics camera;
  camera.size = readSize(node.required("size"), 1, kMaxExtent);
  camera.fx = node.required("fx").number(kTiny, kHuge);
  camera.fy = node.required("fy").number(kTiny, kHuge);
  camera.cx = node.required("cx").number(-kMaxCoordinate, kMaxCoordinate);
  camera.cy = node.required("cy").number(-kMaxCoordinate, kMaxCoordinate);
  camera.radial = readArray<3>(node.required("radial"));
  camera.tangential = readArray<2>(node.required("tangential"));
  camera.rmsPx = node.required("rms_px").number(0, kHuge);
  camera.photos = node.required("photos").integer(0, 1'000'000);
  if (const Node file = node.optional("response"); file.defined()) camera.response = readText(file, kMaxPath);
  node.refuseUnknownKeys();
  return camera;
}

std::optional<Bend> readBend(const Node& node) {
  if (!node.defined()) return std::nullopt;
  Bend bend;
  bend.radius = node.required("radius").number(-kHuge, kHuge);
  if (!(std::abs(bend.radius) >= kTiny)) node.problem("a radius of nothing");
  bend.apex = node.required("apex").number(-kMaxCoordinate, kMaxCoordinate);
  bend.depth = readArray<3>(node.required("depth"));
  node.refuseUnknownKeys();
  return bend;
}

SurfaceFit readSurface(const Node& node) {
  SurfaceFit surface;
  surface.wallFromCamera = readCollineation(node.required("wall_from_camera"));
  surface.bend = readBend(node.optional("bend"));
  surface.rms = node.required("rms").number(0, kHuge);
  node.refuseUnknownKeys();
  return surface;
}

Display readDisplay(const Node& node) {
  const Node rect = node.required("rect");
  const auto edges = rect.numbers(4, -kMaxCoordinate, kMaxCoordinate);
  if (rect.size() == 4 && !(edges[0] < edges[2] && edges[1] < edges[3])) {
    rect.problem("expected [left, top, right, bottom] with left < right and top < bottom");
  }
  const Node resolution = node.required("resolution");
  const devices::Size size = readSize(resolution, 1, kMaxExtent);
  if (size.area() > kMaxDesktopArea) resolution.problem("a desktop of more than 2^29 pixels");
  node.refuseUnknownKeys();
  return {edges[0], edges[1], edges[2], edges[3], size};
}

Sample readSample(const Node& node) {
  const auto values = node.numbers(4, -kMaxCoordinate, kMaxCoordinate);
  return {{values[0], values[1]}, {values[2], values[3]}};
}

ResidualSpline readResidual(const Node& node) {
  constexpr int kMostCells = 256;
  ResidualSpline spline;
  spline.columns = node.required("columns").integer(1, kMostCells);
  spline.rows = node.required("rows").integer(1, kMostCells);
  const auto count = static_cast<std::size_t>(spline.columns + 3) * static_cast<std::size_t>(spline.rows + 3);
  for (const Node& point : node.required("control").elements(0, kMaxSamples)) {
    spline.control.push_back(readPoint(point));
  }
  if (spline.control.size() != count) {
    node.problem("expected " + std::to_string(count) + " control points, found " +
                 std::to_string(spline.control.size()));
  }
  node.refuseUnknownKeys();
  return spline;
}

ProjectorModel readModel(const Node& node) {
  ProjectorModel model;
  model.projectorFromWall = readCollineation(node.required("projector_from_wall"));
  model.centre = readPoint(node.required("centre"));
  model.scale = node.required("scale").number(kTiny, kHuge);
  model.radial = readArray<3>(node.required("radial"));
  model.tangential = readArray<2>(node.required("tangential"));
  model.bend = readBend(node.optional("bend"));
  if (const Node residual = node.optional("residual"); residual.defined()) model.residual = readResidual(residual);
  node.refuseUnknownKeys();
  return model;
}

FitQuality readQuality(const Node& node) {
  FitQuality quality;
  quality.rms = node.required("rms_px").number(0, kHuge);
  quality.p95 = node.required("p95_px").number(0, kHuge);
  quality.maximum = node.required("max_px").number(0, kHuge);
  const auto optionalNumber = [&](const char* key) {
    const Node value = node.optional(key);
    return value.defined() ? value.number(0, kHuge) : 0;
  };
  quality.heldOut = optionalNumber("held_out_px");
  quality.deviation = optionalNumber("deviation_px");
  quality.cameraScale = optionalNumber("camera_scale");
  quality.found = node.required("found").integer(0, kMaxSamples);
  quality.shown = node.required("shown").integer(0, kMaxSamples);
  if (quality.found > quality.shown) node.problem("more found than shown");
  node.refuseUnknownKeys();
  return quality;
}

/// Of the projector's own full red, green and blue.
std::array<double, 3> readLightColour(const Node& node) {
  std::array<double, 3> colour{};
  const auto channels = node.elements(3, 3);
  for (std::size_t c = 0; c < 3; ++c) colour.at(c) = channels.at(c).number(0, 1);
  return colour;
}

LightMatch readLight(const Node& node) {
  LightMatch light;
  light.colour = readArray<9>(node.required("colour"));
  if (const Node file = node.optional("gain"); file.defined()) light.gain = readText(file, kMaxPath);
  if (const Node file = node.optional("black"); file.defined()) light.black = readText(file, kMaxPath);
  if (const Node black = node.optional("largest_black"); black.defined()) light.largestBlack = readLightColour(black);
  node.refuseUnknownKeys();
  return light;
}

MeasuredLight readMeasured(const Node& node) {
  MeasuredLight measured;
  measured.white = readText(node.required("white"), kMaxPath);
  measured.brightest = node.required("brightest").number(kTiny, kHuge);
  measured.primaries = readArray<9>(node.required("primaries"));
  measured.primariesKnown = node.required("primaries_known").boolean();
  if (const Node leak = node.optional("leak"); leak.defined()) measured.leak = leak.number(0, 1);
  node.refuseUnknownKeys();
  return measured;
}

ProjectorCalibration readProjector(const Node& node) {
  ProjectorCalibration projector;
  projector.name = readName(node.required("name"));
  projector.resolution = readSize(node.required("resolution"), kMinResolution, kMaxResolution);
  for (const Node& sample : node.required("samples").elements(0, kMaxSamples)) {
    projector.samples.push_back(readSample(sample));
  }
  const Node model = node.optional("model");
  if (model.defined()) projector.model = readModel(model);
  if (!model.defined() && node.isMap()) node.problem("no model: run pixelflex calibrate WALL mesh");
  if (const Node quality = node.optional("quality"); quality.defined()) projector.quality = readQuality(quality);
  if (const Node alpha = node.optional("alpha"); alpha.defined()) projector.alpha = readText(alpha, kMaxPath);
  if (const Node file = node.optional("response"); file.defined()) projector.response = readText(file, kMaxPath);
  if (const Node error = node.optional("response_error"); error.defined()) {
    projector.responseError = error.number(0, kHuge);
  }
  if (const Node leak = node.optional("leak"); leak.defined()) projector.leak = leak.number(0, 1);
  if (const Node seen = node.optional("measured_light"); seen.defined()) projector.measured = readMeasured(seen);
  if (const Node light = node.optional("light"); light.defined()) projector.light = readLight(light);
  projector.flatAt = readFlat(node.optional("flat"), projector.resolution);
  node.refuseUnknownKeys();
  return projector;
}

void migrate(YamlReader& reader, int version) {
  if (version < 1) reader.moveMember("camera.rms", "camera.rms_px");
  if (version < 1) reader.moveMember("desktop", "display");
}

Calibration readCalibration(const Node& root) {
  Calibration calibration;
  if (const Node node = root.optional("camera"); node.defined()) calibration.camera = readCamera(node);
  if (const Node node = root.optional("surface"); node.defined()) calibration.surface = readSurface(node);
  if (const Node places = root.optional("places"); places.defined()) {
    for (const Node& node : places.elements(0, kMaxProjectors)) calibration.places.push_back(readSurface(node));
  }
  if (const Node node = root.optional("display"); node.defined()) calibration.display = readDisplay(node);
  const Node projectors = root.required("projectors");
  for (const Node& node : projectors.elements(0, kMaxProjectors)) {
    calibration.projectors.push_back(readProjector(node));
  }
  checkUniqueNames(projectors);
  const Node steps = root.optional("steps");
  for (const auto& step : steps.keys()) calibration.steps[step] = readText(steps.optional(step), kMaxPath);
  root.refuseUnknownKeys();
  return calibration;
}

}  // namespace

Calibration parseCalibration(std::string_view text, const std::string& file) {
  YamlReader reader(text, file);
  migrate(reader, reader.readHeader("pixelflex-calibration", kCalibrationVersion));
  Calibration calibration = readCalibration(reader.root());
  reader.throwIfProblems();
  return calibration;
}

}  // namespace pixelflex::calib
