#include <fmt/core.h>

#include <string>

#include "calib/store/store.h"
#include "calib/store/yaml_text.h"

namespace pixelflex::calib {
namespace {

std::string shapeText(const Surface& surface) {
  if (surface.shape == SurfaceShape::kCamera) return "camera";
  if (surface.shape == SurfaceShape::kPlanar) return "planar";
  return fmt::format("{{cylinder: {{radius: {}}}}}", yamlNumber(surface.cylinderRadius));
}

std::string fiducialText(const Fiducial& fiducial) {
  std::string text = "{";
  if (fiducial.aruco) text += fmt::format("aruco: {}, ", *fiducial.aruco);
  if (const auto& point = fiducial.pointInCamera) text += fmt::format("camera: {}, ", yamlList({point->x, point->y}));
  return fmt::format("{}at: {}}}", text, yamlList({fiducial.pointInWall.x, fiducial.pointInWall.y}));
}

std::string surfaceText(const Surface& surface) {
  std::string text = fmt::format("surface:\n  shape: {}\n  units: {}\n", shapeText(surface), yamlText(surface.units));
  if (!surface.fiducials.empty()) text += "  fiducials:\n";
  for (const auto& fiducial : surface.fiducials) text += fmt::format("    - {}\n", fiducialText(fiducial));
  return text;
}

std::string transferText(Transfer transfer) {
  return transfer == Transfer::kLinear ? "linear" : "srgb";
}

std::string cameraText(const CameraSource& camera) {
  std::string text = fmt::format("camera:\n  source: {}\n", yamlText(camera.source));
  if (camera.latency) text += fmt::format("  latency: {}\n", yamlNumber(*camera.latency));
  if (camera.transfer) text += fmt::format("  transfer: {}\n", transferText(*camera.transfer));
  if (!camera.checkerboard) return text;
  const auto& board = *camera.checkerboard;
  return fmt::format("{}  checkerboard: {{corners: [{}, {}], square: {}}}\n", text, board.columns, board.rows,
                     yamlNumber(board.square));
}

std::string outputText(const Output& output) {
  if (output.kind == OutputKind::kNone) return "none";
  if (output.kind == OutputKind::kSim) return "sim";
  if (output.kind == OutputKind::kMonitor) return fmt::format("{{monitor: {}}}", yamlText(output.monitor));
  return fmt::format("{{display: {}, at: [{}, {}]}}", yamlText(output.display), output.at.x, output.at.y);
}

std::string deviceText(std::string_view key, const std::optional<DeviceLine>& line) {
  if (!line) return "";
  const std::string password = line->passwordFile ? ", password_file: " + yamlText(*line->passwordFile) : "";
  return fmt::format("    {}: {{driver: {}, at: {}{}}}\n", key, yamlText(line->driver), yamlText(line->at), password);
}

std::string projectorText(const ProjectorConfig& projector) {
  std::string text = fmt::format("  - name: {}\n    resolution: [{}, {}]\n    output: {}\n", yamlText(projector.name),
                                 projector.resolution.width, projector.resolution.height, outputText(projector.output));
  if (projector.gammaByCamera) text += "    gamma: camera\n";
  if (projector.gamma) text += fmt::format("    gamma: {}\n", yamlText(*projector.gamma));
  text += deviceText("control", projector.control) + deviceText("mirror", projector.mirror);
  if (const auto& at = projector.flatAt) text += fmt::format("    flat: {{at: [{}, {}]}}\n", at->x, at->y);
  return text;
}

std::string blendText(const Blend& blend) {
  std::string text = fmt::format("blend: {{density_exponent: {}", yamlNumber(blend.densityExponent));
  if (blend.priorityFeather > 0) text += ", priority_feather: " + yamlNumber(blend.priorityFeather);
  if (blend.stack == StackRule::kLeftRight) text += ", stack: left-right";
  if (blend.uniformity) text += ", uniformity: " + yamlNumber(*blend.uniformity);
  if (blend.evenBlack) text += ", black: even";
  return text + "}\n";
}

std::string displayText(const DisplayRequest& display) {
  std::string aspect = "any";
  if (const auto& ratio = display.aspect) {
    aspect = fmt::format("{}:{}", yamlNumber(ratio->width), yamlNumber(ratio->height));
  }
  return fmt::format("display: {{aspect: {}, margin: {}}}\n", aspect, display.margin);
}

std::string filterText(DesktopFilter filter) {
  if (filter == DesktopFilter::kBilinear) return "bilinear";
  return filter == DesktopFilter::kNearest ? "nearest" : "catmull-rom";
}

std::string desktopText(const DesktopRequest& desktop) {
  std::string density = desktop.density == DensityRule::kMax ? "max" : "mean";
  if (desktop.density == DensityRule::kFixed) density = yamlNumber(desktop.pixelsPerUnit);
  return fmt::format("desktop: {{density: {}, oversampling: {}, filter: {}, filter_domain: {}}}\n", density,
                     yamlNumber(desktop.oversampling), filterText(desktop.filter),
                     desktop.filterDomain == FilterDomain::kLinear ? "linear" : "srgb");
}

}  // namespace

std::string formatWall(const Wall& wall) {
  std::string text = fmt::format(
      "# A PixelFlex wall: what there is. Check it with: pixelflex check WALL\nformat: pixelflex-wall\nversion: {}\n",
      kWallVersion);
  if (wall.rig) text += fmt::format("rig: {}\n", yamlText(*wall.rig));
  text += surfaceText(wall.surface) + cameraText(wall.camera) + "projectors:\n";
  for (const auto& projector : wall.projectors) text += projectorText(projector);
  text += blendText(wall.blend);
  text += displayText(wall.display) + desktopText(wall.desktop);
  return text + fmt::format("transfer: {}\n", transferText(wall.transfer));
}

}  // namespace pixelflex::calib
