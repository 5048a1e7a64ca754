#include <fmt/core.h>

#include <string>

#include "calib/store/store.h"
#include "calib/store/yaml_text.h"

namespace pixelflex::calib {
namespace {

std::string cameraText(const CameraIntrinsics& camera) {
  std::string text = fmt::format(
      "camera:\n  size: [{}, {}]\n  fx: {}\n  fy: {}\n  cx: {}\n  cy: {}\n  radial: {}\n  tangential: {}\n"
      "  rms_px: {}\n  photos: {}\n",
      camera.size.width, camera.size.height, yamlNumber(camera.fx), yamlNumber(camera.fy), yamlNumber(camera.cx),
      yamlNumber(camera.cy), yamlList(camera.radial), yamlList(camera.tangential), yamlNumber(camera.rmsPx),
      camera.photos);
  return camera.response ? text + fmt::format("  response: {}\n", yamlText(*camera.response)) : text;
}

std::string bendText(const Bend& bend) {
  return fmt::format("{{radius: {}, apex: {}, depth: {}}}", yamlNumber(bend.radius), yamlNumber(bend.apex),
                     yamlList(bend.depth));
}

std::string residualText(const ResidualSpline& spline) {
  std::string points;
  for (const auto& point : spline.control) {
    points += (points.empty() ? "" : ", ") + yamlList({point.x, point.y});
  }
  return fmt::format("      residual: {{columns: {}, rows: {}, control: [{}]}}\n", spline.columns, spline.rows, points);
}

/// Lines of a block mapping at this indentation.
std::string surfaceText(const SurfaceFit& surface, const std::string& indent) {
  std::string text = fmt::format("wall_from_camera: {}\n{}rms: {}\n", yamlList(surface.wallFromCamera), indent,
                                 yamlNumber(surface.rms));
  return surface.bend ? text + fmt::format("{}bend: {}\n", indent, bendText(*surface.bend)) : text;
}

std::string placesText(const std::vector<SurfaceFit>& places) {
  if (places.empty()) return "";
  std::string text = "places:\n";
  for (const auto& place : places) text += "  - " + surfaceText(place, "    ");
  return text;
}

std::string displayText(const Display& display) {
  return fmt::format("display:\n  rect: {}\n  resolution: [{}, {}]\n",
                     yamlList({display.left, display.top, display.right, display.bottom}), display.resolution.width,
                     display.resolution.height);
}

std::string modelText(const ProjectorModel& model) {
  std::string text = fmt::format(
      "    model:\n      projector_from_wall: {}\n      centre: {}\n      scale: {}\n      radial: {}\n"
      "      tangential: {}\n",
      yamlList(model.projectorFromWall), yamlList({model.centre.x, model.centre.y}), yamlNumber(model.scale),
      yamlList(model.radial), yamlList(model.tangential));
  if (model.bend) text += fmt::format("      bend: {}\n", bendText(*model.bend));
  return model.residual ? text + residualText(*model.residual) : text;
}

std::string qualityText(const FitQuality& quality) {
  std::string text =
      fmt::format("    quality: {{rms_px: {}, p95_px: {}, max_px: {}, found: {}, shown: {}", yamlNumber(quality.rms),
                  yamlNumber(quality.p95), yamlNumber(quality.maximum), quality.found, quality.shown);
  const auto add = [&text](const char* key, double value) {
    if (value > 0) text += fmt::format(", {}: {}", key, yamlNumber(value));
  };
  add("held_out_px", quality.heldOut);
  add("deviation_px", quality.deviation);
  add("camera_scale", quality.cameraScale);
  return text + "}\n";
}

std::string samplesText(const std::vector<Sample>& samples) {
  if (samples.empty()) return "    samples: []\n";
  std::string text = "    samples:\n";
  for (const auto& [projector, wall] : samples) {
    text += fmt::format("      - {}\n", yamlList({projector.x, projector.y, wall.x, wall.y}));
  }
  return text;
}

std::string lightText(const LightMatch& light) {
  std::string text = fmt::format("    light: {{colour: {}", yamlList(light.colour));
  if (light.gain) text += ", gain: " + yamlText(*light.gain);
  if (light.black) {
    text += fmt::format(", black: {}, largest_black: {}", yamlText(*light.black), yamlList(light.largestBlack));
  }
  return text + "}\n";
}

std::string measuredText(const MeasuredLight& measured) {
  std::string text = fmt::format("    measured_light: {{white: {}, brightest: {}, primaries: {}, primaries_known: {}",
                                 yamlText(measured.white), yamlNumber(measured.brightest), yamlList(measured.primaries),
                                 measured.primariesKnown);
  if (measured.leak) text += ", leak: " + yamlNumber(*measured.leak);
  return text + "}\n";
}

std::string projectorText(const ProjectorCalibration& projector) {
  std::string text =
      fmt::format("  - name: {}\n    resolution: [{}, {}]\n{}{}", yamlText(projector.name), projector.resolution.width,
                  projector.resolution.height, modelText(projector.model), qualityText(projector.quality));
  if (projector.alpha) text += fmt::format("    alpha: {}\n", yamlText(*projector.alpha));
  if (projector.response) text += fmt::format("    response: {}\n", yamlText(*projector.response));
  if (projector.responseError) text += fmt::format("    response_error: {}\n", yamlNumber(*projector.responseError));
  if (projector.leak) text += fmt::format("    leak: {}\n", yamlNumber(*projector.leak));
  if (projector.measured) text += measuredText(*projector.measured);
  if (projector.light) text += lightText(*projector.light);
  if (const auto& at = projector.flatAt) text += fmt::format("    flat: {{at: [{}, {}]}}\n", at->x, at->y);
  return text + samplesText(projector.samples);
}

}  // namespace

std::string formatCalibration(const Calibration& calibration) {
  std::string text = fmt::format(
      "# A PixelFlex calibration: what was measured. Written by pixelflex calibrate.\n"
      "format: pixelflex-calibration\nversion: {}\n",
      kCalibrationVersion);
  if (calibration.camera) text += cameraText(*calibration.camera);
  if (calibration.surface) text += "surface:\n  " + surfaceText(*calibration.surface, "  ");
  text += placesText(calibration.places);
  if (calibration.display) text += displayText(*calibration.display);
  text += calibration.projectors.empty() ? "projectors: []\n" : "projectors:\n";
  for (const auto& projector : calibration.projectors) text += projectorText(projector);
  if (!calibration.steps.empty()) text += "steps:\n";
  for (const auto& [step, fingerprint] : calibration.steps) {
    text += fmt::format("  {}: {}\n", yamlText(step), yamlText(fingerprint));
  }
  return text;
}

}  // namespace pixelflex::calib
