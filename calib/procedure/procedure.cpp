#include "calib/procedure/procedure.h"

#include <algorithm>
#include <utility>

#include "calib/estimate/intrinsics.h"
#include "calib/patterns/blob_pattern.h"
#include "calib/photometric/response_curve.h"
#include "calib/procedure/camera_step.h"
#include "calib/procedure/display_step.h"
#include "calib/procedure/fingerprint.h"
#include "calib/procedure/geometry_step.h"
#include "calib/procedure/light_step.h"
#include "calib/procedure/mask_step.h"
#include "calib/procedure/surface_step.h"
#include "calib/procedure/wording.h"
#include "calib/store/readings_file.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {

namespace {

/// Of white, as an instrument read it; negative when that cannot be told.
double leakOf(const std::filesystem::path& file) {
  const Readings readings = readReadings(readStoreFile(file.string()), file.string());
  double black = 0;
  double white = 0;
  for (const auto& channel : readings.light) {
    black += channel.front();
    white += channel.back();
  }
  return readings.problems.empty() && white > black ? black / (white - black) : -1;
}

}  // namespace

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

bool Procedure::stale(const std::string& step) const {
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

std::string Procedure::runCamera() {
  auto& source = photographs("camera");
  tookPhotographs_ = true;
  const auto response = calibration_.camera ? calibration_.camera->response : std::nullopt;
  calibration_.camera = measureCamera(wall_.camera, source, progress_);
  calibration_.camera->response = response;
  const CameraIntrinsics& camera = knownCamera();
  if (camera.photos == 0) return "known intrinsics, " + sizeText(camera.size);
  return count(static_cast<std::size_t>(camera.photos), "photograph") + ", reprojection " + rounded(camera.rmsPx, 3) +
         " px RMS";
}

std::string Procedure::runSurface() {
  calibration_.places.clear();
  if (wall_.surface.shape == SurfaceShape::kCamera) {
    calibration_.surface = SurfaceFit{};
    return "as the camera sees it";
  }
  tookPhotographs_ = tookPhotographs_ || photographs_ != nullptr;
  if (photographs_ != nullptr && photographs_->placeCount() > 1) {
    // Solved with the projectors, which tie the places together; until then nothing is known.
    calibration_.surface = SurfaceFit{};
    return count(static_cast<std::size_t>(photographs_->placeCount()), "camera place") + ", solved with the projectors";
  }
  const SeenFiducials seen = findFiducials(wall_, knownCamera(), photographs_, 0);
  calibration_.surface = measureSurface(wall_.surface, knownCamera(), seen, progress_);
  return count(seen.pairs.size(), "fiducial") + ", fit " + rounded(calibration_.surface->rms, 3) + " " +
         wall_.surface.units + " RMS";
}

std::vector<const ProjectorConfig*> Procedure::wantedProjectors() const {
  std::vector<const ProjectorConfig*> wanted;
  for (const auto& config : wall_.projectors) {
    if (options_.skip.contains(config.name)) continue;
    if (options_.only.empty() || options_.only.contains(config.name)) wanted.push_back(&config);
  }
  return wanted;
}

std::string Procedure::runProjectors() {
  auto& source = photographs("projectors");
  tookPhotographs_ = true;
  const auto wanted = wantedProjectors();
  const std::vector<ProjectorCalibration> before = calibration_.projectors;
  std::erase_if(calibration_.projectors,
                [&](const auto& known) { return options_.only.empty() || options_.only.contains(known.name); });
  const std::size_t kept = calibration_.projectors.size();
  ProjectorStep step(knownCamera(), method_, source, progress_,
                     [this](const std::string& name, const std::string& problem) { reportFailure(name, problem); });
  const auto seen = step.observe(wanted);
  if (seen.empty()) throw ProcedureError("no projector could be calibrated");
  const auto surfaces = surfacesFor(seen);
  for (const auto& projector : seen) addProjector(projector, surfaces);
  for (const auto& known : before) keepLight(known);
  if (calibration_.projectors.size() == kept) throw ProcedureError("no projector could be calibrated");
  std::ranges::sort(calibration_.projectors, {}, [&](const ProjectorCalibration& p) {
    return std::ranges::find(wall_.projectors, p.name, &ProjectorConfig::name) - wall_.projectors.begin();
  });
  return count(calibration_.projectors.size() - kept, "projector") + " of " + std::to_string(wanted.size());
}

/// Repairs measure against the surfaces that are stored; so does everything from a single place.
std::vector<SurfaceFit> Procedure::surfacesFor(const std::vector<SeenProjector>& seen) {
  const auto places = static_cast<std::size_t>(photographs("projectors").placeCount());
  if (places == 1) return {knownSurfaces().front()};
  if (!options_.only.empty()) {
    if (knownSurfaces().size() != places) {
      throw ProcedureError("the wall was measured from " + count(knownSurfaces().size(), "camera place") + ", not " +
                           std::to_string(places) + ": photograph it again from the same places, or all of it");
    }
    return knownSurfaces();
  }
  std::vector<std::vector<PointPair>> fiducials;
  for (std::size_t place = 0; place < places; ++place) {
    photographs_->choosePlace(static_cast<int>(place));
    const bool any = photographs_->hasFiducials();
    fiducials.push_back(any ? findFiducials(wall_, knownCamera(), photographs_, static_cast<int>(place)).pairs
                            : std::vector<PointPair>{});
    progress_.advance(static_cast<int>(place) + 1, static_cast<int>(places), "fiducials");
  }
  auto surfaces = solveSurfaces(seen, std::move(fiducials));
  calibration_.surface = surfaces.front();
  calibration_.places.assign(surfaces.begin() + 1, surfaces.end());
  return surfaces;
}

/// Until it is measured again.
void Procedure::keepLight(const ProjectorCalibration& known) {
  const auto now = std::ranges::find(calibration_.projectors, known.name, &ProjectorCalibration::name);
  if (now == calibration_.projectors.end()) return;
  now->light = known.light;
  now->measured = known.measured;
}

void Procedure::addProjector(const SeenProjector& seen, const std::vector<SurfaceFit>& surfaces) {
  try {
    ProjectorCalibration projector = calibrateProjector(seen, surfaces);
    const SurfaceFit& surface = surfaces.at(seen.views.front().place);
    checkFlatness(wall_.surface, knownCamera(), surface, seen, projector);
    if (const auto nudge = nudges_.find(projector.name); nudge != nudges_.end()) projector.nudge = nudge->second;
    calibration_.projectors.push_back(std::move(projector));
  } catch (const EstimateError& error) {
    reportFailure(seen.config->name, error.what());
  }
}

void Procedure::reportFailure(const std::string& name, const std::string& problem) {
  const std::string message = "projector " + name + ": " + problem;
  if (!options_.goOnWithoutFailed) throw ProcedureError(message);
  progress_.warn(message + "; left out");
}

std::string Procedure::keepOrFindDisplay() {
  if (displayIsLit(calibration_)) return "desktop stays " + sizeText(knownDisplay().resolution);
  progress_.warn("the old display is not wholly lit any more; a new one was found");
  return runMesh();
}

std::string Procedure::runMesh() {
  calibration_.display = measureDisplay(wall_, calibration_);
  return "desktop " + sizeText(knownDisplay().resolution);
}

std::string Procedure::runBlend() {
  const auto masks = paintMasks(wall_.blend, calibration_.projectors, progress_);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    auto& projector = calibration_.projectors[i];
    projector.alpha = "calibration/" + projector.name + "-alpha.png";
    masks_[*projector.alpha] = masks[i];
  }
  return count(masks.size(), "mask");
}

std::string Procedure::runGamma() {
  std::size_t measured = 0;
  const auto byCamera = responsesByCamera();
  for (auto& projector : calibration_.projectors) {
    if (keepsResponse(projector.name)) {
      measured += projector.response ? 1 : 0;
      continue;
    }
    projector.response.reset();
    projector.responseError.reset();
    projector.leak.reset();
    if (options_.only.empty()) {
      projector.light.reset();
      projector.measured.reset();
    }
    const auto config = std::ranges::find(wall_.projectors, projector.name, &ProjectorConfig::name);
    if (config == wall_.projectors.end()) continue;
    if (const auto found = byCamera.find(projector.name); found != byCamera.end()) {
      projector.response = "calibration/" + projector.name + "-response.csv";
      projector.responseError = found->second.error;
      projector.leak = found->second.leak;
      responses_[*projector.response] = formatReadings(found->second.curve);
      ++measured;
    }
    const auto& gamma = config->gamma;
    if (!gamma) continue;
    const std::string file = (folder_ / *gamma).string();
    projector.response = "calibration/" + projector.name + "-response.csv";
    responses_[*projector.response] = formatReadings(withoutNoise(parseReadings(readStoreFile(file), file)));
    ++measured;
  }
  const std::size_t assumed = calibration_.projectors.size() - measured;
  const std::string error = byCamera.empty() ? "" : ", by camera to " + rounded(100 * typicalError(byCamera), 1) + " %";
  const std::string responses =
      count(measured, "response") + error + (assumed > 0 ? ", sRGB assumed for " + std::to_string(assumed) : "");
  return wall_.blend.matchesLight() && options_.only.empty() ? responses + ", " + matchProjectors() : responses;
}

std::map<std::string, MeasuredResponse> Procedure::responsesByCamera() {
  if (!measuresResponses()) return {};
  tookResponses_ = true;
  auto result =
      measureResponses(wall_, calibration_, options_.only, photographs("gamma"), progress_,
                       [this](const std::string& name, const std::string& problem) { reportFailure(name, problem); });
  if (result.camera) {
    camera_ = result.camera;
    calibration_.camera->response = "calibration/camera-response.csv";
    responses_[*calibration_.camera->response] = formatCameraResponse(*camera_);
  }
  return std::move(result.responses);
}

bool Procedure::measuresResponses() const {
  return std::ranges::any_of(wall_.projectors, [this](const ProjectorConfig& projector) {
    return projector.gammaByCamera && calibration_.find(projector.name) != nullptr &&
           (options_.only.empty() || options_.only.contains(projector.name));
  });
}

bool Procedure::keepsResponse(const std::string& projector) const {
  const auto config = std::ranges::find(wall_.projectors, projector, &ProjectorConfig::name);
  const bool byCamera = config != wall_.projectors.end() && config->gammaByCamera;
  return byCamera && !options_.only.empty() && !options_.only.contains(projector);
}

CameraResponse Procedure::knownCameraResponse() const {
  if (camera_) return *camera_;
  const auto& stored = calibration_.camera->response;
  return cameraResponse(wall_.camera, stored ? std::optional((folder_ / *stored).string()) : std::nullopt);
}

std::string Procedure::matchProjectors() {
  auto& source = photographs("gamma");
  std::vector<devices::Image16> masks;
  std::vector<double> leak;
  for (const auto& projector : calibration_.projectors) {
    const std::string path = projector.alpha.value_or("");
    const auto painted = masks_.find(path);
    masks.push_back(painted != masks_.end() ? painted->second : devices::readPng16(folder_ / path));
    const auto config = std::ranges::find(wall_.projectors, projector.name, &ProjectorConfig::name);
    const bool read = config != wall_.projectors.end() && config->gamma;
    leak.push_back(read ? leakOf(folder_ / *config->gamma) : projector.leak.value_or(-1));
  }
  const LightResult light =
      matchLight(wall_, calibration_, method_, masks, leak, knownCameraResponse(), source, progress_);
  for (auto& projector : calibration_.projectors) {
    projector.light = light.matches.at(projector.name);
    projector.measured = light.measured.at(projector.name);
  }
  masks_.insert(light.images.begin(), light.images.end());
  std::string text = "light matched at " + rounded(100 * light.kept, 0) + " % of it";
  if (light.contrastEven > 0) {
    text += ", black even: contrast " + rounded(light.contrastEven, 0) + " of " + rounded(light.contrastNative, 0);
  }
  return text;
}

void Procedure::save() {
  for (const auto& [path, mask] : masks_) devices::writePng(folder_ / path, mask, devices::PngEffort::kFast);
  for (const auto& [path, text] : responses_) devices::writeFileAtomically(folder_ / path, text);
  saveCalibration(folder_, calibration_);
  if (tookPhotographs_ || tookResponses_) photographs_->keep(tookPhotographs_ ? Kept::kAll : Kept::kResponse);
}

}  // namespace pixelflex::calib
