#include "calib/procedure/procedure.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "calib/patterns/blob_pattern.h"
#include "calib/procedure/fingerprint.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {

struct Procedure::Step {
  std::string name;
  std::string (Procedure::*run)();
};

const std::vector<Procedure::Step>& Procedure::steps() {
  static const std::vector<Step> kSteps = {
      {"camera", &Procedure::runCamera}, {"surface", &Procedure::runSurface}, {"projectors", &Procedure::runProjectors},
      {"mesh", &Procedure::runMesh},     {"blend", &Procedure::runBlend},     {"gamma", &Procedure::runGamma}};
  return kSteps;
}

const std::vector<std::string>& stepNames() {
  static const std::vector<std::string> kNames = {"camera", "surface", "projectors", "mesh", "blend", "gamma"};
  return kNames;
}

Procedure::Procedure(std::filesystem::path folder, const Wall& wall, Calibration previous, Photographs* photographs,
                     Progress& progress)
    : folder_(std::move(folder)),
      wall_(wall),
      calibration_(std::move(previous)),
      photographs_(photographs),
      progress_(progress),
      nudges_(loadNudges(folder_)) {}

std::vector<std::string> Procedure::run(const ProcedureOptions& options) {
  options_ = options;
  method_ = chooseMethod();
  if (wall_.surface.shape != SurfaceShape::kPlanar && photographs_ != nullptr && photographs_->placeCount() > 1) {
    throw ProcedureError(
        "several camera places need a flat wall (shape: planar) in this version; photograph a bent "
        "screen from one place");
  }
  if (!options.only.empty()) return runOnly();
  std::vector<std::string> ran;
  for (const auto& step : steps()) {
    const bool asked = std::ranges::find(options.steps, step.name) != options.steps.end();
    const bool wanted = options.steps.empty() ? options.force || stale(step.name) : asked;
    if (!wanted) continue;
    requireEarlier(step.name);
    progress_.beginStep(step.name);
    const std::string result = (this->*step.run)();
    calibration_.steps[step.name] = fingerprint(step.name);
    progress_.endStep(result);
    ran.push_back(step.name);
  }
  return ran;
}

std::vector<std::string> Procedure::runOnly() {
  if (!calibration_.surface || !calibration_.display) {
    throw ProcedureError("--only measures against a calibrated wall: run pixelflex calibrate WALL first");
  }
  const std::vector<Step> repair = {{"projectors", &Procedure::runProjectors},
                                    {"mesh", &Procedure::keepOrFindDisplay},
                                    {"blend", &Procedure::runBlend},
                                    {"gamma", &Procedure::runGamma}};
  std::vector<std::string> ran;
  for (const auto& step : repair) {
    progress_.beginStep(step.name);
    progress_.endStep((this->*step.run)());
    ran.push_back(step.name);
  }
  // What was measured before counts as measured now: the wall is whole again.
  for (const auto& step : steps()) calibration_.steps[step.name] = fingerprint(step.name);
  return ran;
}

/// The method asked for; else the one that was photographed; else the one with which what is stored was measured, so
/// that nothing counts as stale for want of an option; else blobs.
Method Procedure::chooseMethod() const {
  if (options_.method) return *options_.method;
  if (photographs_ != nullptr) {
    if (const auto taken = photographs_->methodTaken()) return *taken;
  }
  const bool dense = std::ranges::any_of(calibration_.projectors,
                                         [](const auto& projector) { return projector.quality.shown > kBlobCount; });
  return dense ? Method::kDense : Method::kBlobs;
}

bool Procedure::canBeRead(const std::optional<std::string>& picture) const try {
  return !picture || devices::readPng16(folder_ / *picture).size().area() > 0;
} catch (const std::runtime_error&) {
  return false;
}

/// The pictures that the step has written are there, whatever somebody did to them since.
bool Procedure::keepsItsPictures(const std::string& step) const {
  return std::ranges::all_of(calibration_.projectors, [&](const ProjectorCalibration& projector) {
    if (step == "blend") return canBeRead(projector.alpha);
    if (step != "gamma") return true;
    const bool hasResponse = !projector.response || std::filesystem::is_regular_file(folder_ / *projector.response);
    return hasResponse && (!projector.light || (canBeRead(projector.light->gain) && canBeRead(projector.light->black)));
  });
}

bool Procedure::stale(const std::string& step) const {
  if (!keepsItsPictures(step)) return true;
  const auto found = calibration_.steps.find(step);
  return found == calibration_.steps.end() || found->second != fingerprint(step);
}

/// Each step's fingerprint holds that of the step before it, so a change runs through to the end.
std::string Procedure::fingerprint(const std::string& step) const {
  Fingerprint print;
  print.add(step);
  const auto previous = [&](const char* name) {
    const auto found = calibration_.steps.find(name);
    print.add(found == calibration_.steps.end() ? "none" : found->second);
  };
  if (step == "camera") {
    const Checkerboard board = wall_.camera.checkerboard.value_or(Checkerboard{});
    print.add(board.columns).add(board.rows).add(board.square).add(measureStamp("checkerboard"));
  } else if (step == "surface") {
    previous("camera");
    print.add(static_cast<int>(wall_.surface.shape)).add(wall_.surface.cylinderRadius);
    for (const auto& f : wall_.surface.fiducials) {
      print.add(f.pointInWall.x).add(f.pointInWall.y).add(f.aruco.value_or(-1));
      if (f.pointInCamera) print.add(f.pointInCamera->x).add(f.pointInCamera->y);
    }
    print.add(measureStamp("fiducials"));
  } else if (step == "projectors") {
    previous("surface");
    for (const auto& p : wall_.projectors) print.add(p.name).add(p.resolution.width).add(p.resolution.height);
    print.add(methodName(method_)).add(measureStamp("patterns"));
  } else if (step == "mesh") {
    previous("projectors");
    const auto aspect = wall_.display.aspect.value_or(AspectRatio{0, 0});
    print.add(aspect.width).add(aspect.height).add(wall_.display.margin);
    print.add(static_cast<int>(wall_.desktop.density)).add(wall_.desktop.pixelsPerUnit).add(wall_.desktop.oversampling);
  } else if (step == "blend") {
    previous("projectors");
    print.add(wall_.blend.densityExponent).add(formatNudges(nudges_));
    if (wall_.blend.priorityFeather > 0) print.add("feather").add(wall_.blend.priorityFeather);
    if (wall_.blend.stack == StackRule::kLeftRight) print.add("left-right");
  } else {
    previous("projectors");
    if (wall_.blend.matchesLight()) {
      print.add(wall_.blend.uniformity.value_or(-1)).add(wall_.blend.evenBlack ? 1 : 0).add(measureStamp("patterns"));
      previous("blend");
    }
    for (const auto& p : wall_.projectors) {
      print.add(p.gamma ? readStoreFile((folder_ / *p.gamma).string()) : p.gammaByCamera ? "camera" : "none");
    }
    const bool byCamera = std::ranges::any_of(wall_.projectors, &ProjectorConfig::gammaByCamera);
    if (byCamera) print.add(measureStamp("response"));
    if (wall_.camera.transfer) print.add(static_cast<int>(*wall_.camera.transfer));
  }
  return print.text();
}

/// Without photographs at hand (a step that needs none was asked for) the measured steps count as unchanged.
std::string Procedure::measureStamp(const std::string& kind) const {
  return photographs_ != nullptr ? photographs_->stamp(kind) : "none";
}

Photographs& Procedure::photographs(const std::string& step) const {
  if (photographs_ == nullptr) {
    throw ProcedureError("step " + step + " needs photographs: give --photos DIR, or a live camera in wall.yaml");
  }
  return *photographs_;
}

const CameraIntrinsics& Procedure::knownCamera() const {
  if (!calibration_.camera) throw ProcedureError("the camera is not calibrated: run pixelflex calibrate WALL camera");
  return *calibration_.camera;
}

std::vector<SurfaceFit> Procedure::knownSurfaces() const {
  if (!calibration_.surface) throw ProcedureError("the surface is not known: run pixelflex calibrate WALL surface");
  std::vector<SurfaceFit> surfaces = {*calibration_.surface};
  surfaces.insert(surfaces.end(), calibration_.places.begin(), calibration_.places.end());
  return surfaces;
}

const Display& Procedure::knownDisplay() const {
  if (!calibration_.display) throw ProcedureError("there is no display yet: run pixelflex calibrate WALL mesh");
  return *calibration_.display;
}

void Procedure::requireEarlier(const std::string& step) const {
  const auto need = [&](bool there, const std::string& earlier) {
    if (!there) throw ProcedureError("step " + step + " needs " + earlier + " first: run pixelflex calibrate WALL");
  };
  if (step == "surface") need(calibration_.camera.has_value(), "camera");
  if (step == "projectors") need(calibration_.surface.has_value(), "surface");
  if (step == "mesh" || step == "blend" || step == "gamma") need(!calibration_.projectors.empty(), "projectors");
}

void Procedure::save() {
  for (const auto& [path, mask] : masks_) devices::writePng(folder_ / path, mask, devices::PngEffort::kFast);
  for (const auto& [path, text] : responses_) devices::writeFileAtomically(folder_ / path, text);
  saveCalibration(folder_, calibration_);
  if (tookPhotographs_ || tookResponses_) photographs_->keep(tookPhotographs_ ? Kept::kAll : Kept::kResponse);
}

}  // namespace pixelflex::calib
