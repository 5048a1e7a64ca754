#include "calib/procedure/procedure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <future>
#include <memory>
#include <utility>

#include "calib/estimate/fiducials.h"
#include "calib/estimate/intrinsics.h"
#include "calib/estimate/projector_fit.h"
#include "calib/geometry/display_area.h"
#include "calib/geometry/patch_mesh.h"
#include "calib/photometric/mask.h"
#include "calib/photometric/response_curve.h"
#include "calib/procedure/fingerprint.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

/// Below this many of the hundred blobs a projector counts as not found.
constexpr int kFewestBlobs = 60;
/// Saturated share of the lit area in the photograph of white from which the photographs are refused.
constexpr double kMostSaturated = 0.05;

std::string rounded(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string sizeText(devices::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string count(std::size_t number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

}  // namespace

struct Procedure::Step {
  std::string name;
  std::string (Procedure::*run)(const ProcedureOptions&);
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
  if (wall_.surface.shape != SurfaceShape::kPlanar) {
    throw ProcedureError("surface: only planar walls can be calibrated by this version; set shape: planar");
  }
  if (!options.only.empty()) return runOnly(options);
  std::vector<std::string> ran;
  for (const auto& step : steps()) {
    const bool asked = std::ranges::find(options.steps, step.name) != options.steps.end();
    const bool wanted = options.steps.empty() ? options.force || stale(step.name) : asked;
    if (!wanted) continue;
    requireEarlier(step.name);
    progress_.beginStep(step.name);
    const std::string result = (this->*step.run)(options);
    calibration_.steps[step.name] = fingerprint(step.name);
    progress_.endStep(result);
    ran.push_back(step.name);
  }
  return ran;
}

std::vector<std::string> Procedure::runOnly(const ProcedureOptions& options) {
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
    progress_.endStep((this->*step.run)(options));
    ran.push_back(step.name);
  }
  // What was measured before counts as measured now: the wall is whole again.
  for (const auto& step : steps()) calibration_.steps[step.name] = fingerprint(step.name);
  return ran;
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
    for (const auto& f : wall_.surface.fiducials) {
      print.add(f.pointInWall.x).add(f.pointInWall.y).add(f.aruco.value_or(-1));
      if (f.pointInCamera) print.add(f.pointInCamera->x).add(f.pointInCamera->y);
    }
    print.add(measureStamp("fiducials"));
  } else if (step == "projectors") {
    previous("surface");
    for (const auto& p : wall_.projectors) print.add(p.name).add(p.resolution.width).add(p.resolution.height);
    print.add(measureStamp("patterns"));
  } else if (step == "mesh") {
    previous("projectors");
    const auto aspect = wall_.display.aspect.value_or(AspectRatio{0, 0});
    print.add(aspect.width).add(aspect.height).add(wall_.display.margin);
    print.add(static_cast<int>(wall_.desktop.density)).add(wall_.desktop.pixelsPerUnit).add(wall_.desktop.oversampling);
  } else if (step == "blend") {
    previous("projectors");
    print.add(wall_.blend.densityExponent).add(formatNudges(nudges_));
  } else {
    previous("projectors");
    for (const auto& p : wall_.projectors) {
      print.add(p.gamma ? readStoreFile((folder_ / *p.gamma).string()) : "none");
    }
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

const SurfaceFit& Procedure::knownSurface() const {
  if (!calibration_.surface) throw ProcedureError("the surface is not known: run pixelflex calibrate WALL surface");
  return *calibration_.surface;
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

std::string Procedure::runCamera(const ProcedureOptions&) {
  auto& source = photographs("camera");
  tookPhotographs_ = true;
  if (const auto known = source.knownCamera()) {
    calibration_.camera = known;
    return "known intrinsics, " + sizeText(known->size);
  }
  const Checkerboard board = wall_.camera.checkerboard.value_or(Checkerboard{});
  std::vector<CheckerboardView> views;
  devices::Size size;
  int seen = 0;
  // clang-tidy does not see that the loop is entered only with a photograph.
  // NOLINTBEGIN(bugprone-unchecked-optional-access)
  while (const auto shot = source.nextCheckerboard()) {
    if (seen > 0 && shot->photo.size() != size) {
      throw ProcedureError(shot->name + ": not of the same size as the photographs before it");
    }
    size = shot->photo.size();
    if (const auto corners = findCheckerboard(shot->photo, board)) {
      views.push_back({shot->name, *corners});
    } else {
      progress_.warn(shot->name + ": no checkerboard of " + std::to_string(board.columns) + "x" +
                     std::to_string(board.rows) + " inner corners found; left out");
    }
    progress_.advance(++seen, source.checkerboardCount(), "checkerboard");
  }
  // NOLINTEND(bugprone-unchecked-optional-access)
  if (seen == 0) {
    throw ProcedureError(
        "no checkerboard photographs (checkerboard/*.png) and no camera.yaml: about 15 photographs of the board are "
        "needed once per camera");
  }
  try {
    calibration_.camera = calibrateCamera(views, board, size);
  } catch (const EstimateError& error) {
    throw ProcedureError(std::string("camera: ") + error.what());
  }
  return count(static_cast<std::size_t>(knownCamera().photos), "photograph") + ", reprojection " +
         rounded(knownCamera().rmsPx, 3) + " px RMS";
}

std::string Procedure::runSurface(const ProcedureOptions&) {
  const FiducialSearch found = findFiducials(CameraMapping(knownCamera()));
  if (found.pairs.size() < 4) {
    throw ProcedureError(found.photo + ": fewer than four fiducials: " + std::to_string(found.pairs.size()) + " of " +
                         std::to_string(wall_.surface.fiducials.size()) +
                         " found; markers not found: " + found.missing +
                         " (are they in the picture, evenly lit, at least 24 pixels wide, with a white border?)");
  }
  if (!found.missing.empty()) progress_.warn(found.photo + ": markers not found: " + found.missing);
  try {
    const Homography wallFromCamera = solveCollineation(found.pairs);
    calibration_.surface = SurfaceFit{wallFromCamera.rowMajor(), rmsError(wallFromCamera, found.pairs)};
  } catch (const EstimateError& error) {
    throw ProcedureError("surface: " + std::string(error.what()));
  }
  return count(found.pairs.size(), "fiducial") + ", fit " + rounded(knownSurface().rms, 3) + " " + wall_.surface.units +
         " RMS";
}

/// Fiducials whose pixels a person gave need no photograph; markers are looked for in one.
Procedure::FiducialSearch Procedure::findFiducials(const CameraMapping& camera) {
  FiducialSearch search;
  std::map<int, glm::dvec2> markers;
  const bool anyMarker =
      std::ranges::any_of(wall_.surface.fiducials, [](const Fiducial& f) { return f.aruco.has_value(); });
  if (anyMarker) {
    auto& source = photographs("surface");
    tookPhotographs_ = true;
    const auto shot = source.fiducials();
    search.photo = shot.name;
    if (shot.photo.size() != knownCamera().size) {
      throw ProcedureError(shot.name + ": " + sizeText(shot.photo.size()) +
                           " pixels, but the camera was calibrated at " + sizeText(knownCamera().size));
    }
    markers = findMarkers(shot.photo, camera);
  }
  for (const auto& fiducial : wall_.surface.fiducials) {
    if (fiducial.pointInCamera) {
      search.pairs.push_back({camera.undistortedFromRaw(*fiducial.pointInCamera), fiducial.pointInWall});
    } else if (const auto found = markers.find(fiducial.aruco.value_or(-1)); found != markers.end()) {
      search.pairs.push_back({found->second, fiducial.pointInWall});
    } else {
      search.missing += (search.missing.empty() ? "" : ", ") + std::to_string(fiducial.aruco.value_or(-1));
    }
  }
  return search;
}

std::string Procedure::runProjectors(const ProcedureOptions& options) {
  auto& source = photographs("projectors");
  tookPhotographs_ = true;
  const CameraMapping camera(knownCamera());
  std::vector<std::pair<const ProjectorConfig*, std::future<DecodedBlobs>>> decoding;
  const auto wanted = [&](const std::string& name) {
    return !options.skip.contains(name) && (options.only.empty() || options.only.contains(name));
  };
  std::erase_if(calibration_.projectors,
                [&](const auto& known) { return options.only.empty() || options.only.contains(known.name); });
  const std::size_t kept = calibration_.projectors.size();
  const auto measured = std::ranges::count_if(wall_.projectors, wanted, &ProjectorConfig::name);
  const int total = static_cast<int>(measured) * kPatternCount;
  int done = 0;
  for (const auto& config : wall_.projectors) {
    if (!wanted(config.name)) continue;
    done += kPatternCount;
    if (!source.hasProjector(config.name)) {
      progress_.warn("projector " + config.name + ": nothing was photographed of it; left out");
      continue;
    }
    const BlobLayout layout(config.resolution);
    auto photos = std::make_unique<PatternPhotos>();
    int shown = 0;
    for (const Pattern pattern : allPatterns()) {
      auto& photo = (*photos)[static_cast<std::size_t>(pattern)];
      photo = source.pattern(config.name, projected(pattern, layout));
      if (photo.size() != knownCamera().size) {
        throw ProcedureError(patternPath(config.name, projected(pattern, layout)).string() +
                             ": not of the size that the camera was " + "calibrated at");
      }
      progress_.advance(done - kPatternCount + ++shown, total, config.name + "/" + patternName(pattern));
    }
    // One decoder at a time beside the camera: two cores, and a bounded number of photographs in memory.
    if (!decoding.empty()) decoding.back().second.wait();
    decoding.emplace_back(&config,
                          std::async(std::launch::async, [photos = std::move(photos), layout, camera]() mutable {
                            // Held here, not by the future: the photographs are many and large.
                            const auto own = std::move(photos);
                            return decodeBlobs(*own, layout, camera);
                          }));
  }
  for (auto& [config, decoded] : decoding) addProjector(*config, decoded.get(), options);
  if (calibration_.projectors.size() == kept) throw ProcedureError("no projector could be calibrated");
  std::ranges::sort(calibration_.projectors, {}, [&](const ProjectorCalibration& p) {
    return std::ranges::find(wall_.projectors, p.name, &ProjectorConfig::name) - wall_.projectors.begin();
  });
  return count(calibration_.projectors.size() - kept, "projector") + " of " + std::to_string(measured);
}

void Procedure::addProjector(const ProjectorConfig& config, const DecodedBlobs& decoded,
                             const ProcedureOptions& options) {
  const int found = static_cast<int>(decoded.blobs.size());
  if (decoded.saturatedShare > kMostSaturated) {
    // Spots may still be found, but where white is clipped their light cannot be divided by it.
    reportFailure(config.name,
                  patternPath(config.name, projected(Pattern::kWhite, BlobLayout(config.resolution))).string() +
                      ".png is over-exposed: " + rounded(100 * decoded.saturatedShare, 0) +
                      " % of the lit area is saturated; shorten the exposure until white stays below 85 %",
                  options);
    return;
  }
  if (found < kFewestBlobs) {
    reportFailure(config.name,
                  std::to_string(found) + " of " + std::to_string(kBlobCount) + " blobs found; " + decoded.hint,
                  options);
    return;
  }
  if (!decoded.hint.empty()) {
    progress_.warn("projector " + config.name + ": " + std::to_string(found) + " of " + std::to_string(kBlobCount) +
                   " blobs found; " + decoded.hint);
  }
  const Homography wallFromCamera(knownSurface().wallFromCamera);
  const BlobLayout layout(config.resolution);
  ProjectorCalibration projector{.name = config.name, .resolution = config.resolution};
  if (const auto nudge = nudges_.find(config.name); nudge != nudges_.end()) projector.nudge = nudge->second;
  for (const auto& blob : decoded.blobs) {
    projector.samples.push_back({layout.centre(blob.id), wallFromCamera.map(blob.pointInUndistorted)});
  }
  try {
    const ProjectorFit fit = fitProjector(projector.samples, config.resolution);
    projector.model = fit.model;
    projector.quality = fit.quality;
    projector.quality.shown = kBlobCount;
  } catch (const EstimateError& error) {
    reportFailure(config.name, error.what(), options);
    return;
  }
  calibration_.projectors.push_back(std::move(projector));
}

void Procedure::reportFailure(const std::string& name, const std::string& problem, const ProcedureOptions& options) {
  const std::string message = "projector " + name + ": " + problem;
  if (!options.goOnWithoutFailed) throw ProcedureError(message);
  progress_.warn(message + "; left out");
}

std::string Procedure::keepOrFindDisplay(const ProcedureOptions& options) {
  std::vector<Outline> outlines;
  for (const auto& projector : calibration_.projectors) outlines.push_back(footprint(ProjectorMapping(projector)));
  if (isLit(knownDisplay(), outlines)) return "desktop stays " + sizeText(knownDisplay().resolution);
  progress_.warn("the old display is not wholly lit any more; a new one was found");
  return runMesh(options);
}

std::string Procedure::runMesh(const ProcedureOptions&) {
  std::vector<Outline> outlines;
  std::vector<double> densities;
  for (const auto& projector : calibration_.projectors) {
    const ProjectorMapping mapping(projector);
    try {
      outlines.push_back(footprint(mapping));
    } catch (const GeometryError& error) {
      throw ProcedureError("projector " + projector.name + ": " + error.what());
    }
    densities.push_back(mapping.meanDensity());
  }
  try {
    calibration_.display = findDisplay(outlines, densities, wall_.display, wall_.desktop);
  } catch (const GeometryError& error) {
    throw ProcedureError(std::string("mesh: ") + error.what());
  }
  return "desktop " + sizeText(knownDisplay().resolution);
}

std::string Procedure::runBlend(const ProcedureOptions&) {
  std::vector<ProjectorMapping> mappings;
  std::vector<double> densities;
  for (const auto& projector : calibration_.projectors) {
    mappings.emplace_back(projector);
    densities.push_back(mappings.back().meanDensity());
  }
  for (std::size_t i = 0; i < mappings.size(); ++i) {
    auto& projector = calibration_.projectors[i];
    projector.alpha = "calibration/" + projector.name + "-alpha.png";
    masks_[*projector.alpha] = alphaMask(i, mappings, densities, wall_.blend.densityExponent);
    progress_.advance(static_cast<int>(i) + 1, static_cast<int>(mappings.size()), projector.name);
  }
  return count(mappings.size(), "mask");
}

std::string Procedure::runGamma(const ProcedureOptions&) {
  std::size_t measured = 0;
  for (auto& projector : calibration_.projectors) {
    projector.response.reset();
    const auto config = std::ranges::find(wall_.projectors, projector.name, &ProjectorConfig::name);
    if (config == wall_.projectors.end()) continue;
    const auto& gamma = config->gamma;
    if (!gamma) continue;
    const std::string file = (folder_ / *gamma).string();
    projector.response = "calibration/" + projector.name + "-response.csv";
    responses_[*projector.response] = formatReadings(parseReadings(readStoreFile(file), file));
    ++measured;
  }
  const std::size_t assumed = calibration_.projectors.size() - measured;
  return count(measured, "response") + (assumed > 0 ? ", sRGB assumed for " + std::to_string(assumed) : "");
}

void Procedure::save() {
  for (const auto& [path, mask] : masks_) devices::writePng(folder_ / path, mask, devices::PngEffort::kFast);
  for (const auto& [path, text] : responses_) devices::writeFileAtomically(folder_ / path, text);
  saveCalibration(folder_, calibration_);
  if (tookPhotographs_) photographs_->keep();
}

}  // namespace pixelflex::calib
