#include "calib/procedure/projector_step.h"

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

#include "calib/patterns/blob_decoder.h"
#include "calib/patterns/blob_light.h"
#include "calib/patterns/dense_decoder.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/wording.h"

namespace pixelflex::calib {
namespace {

/// Below this part of its points a projector counts as not found.
constexpr double kFewestShare = 0.6;
/// From one of several places a projector may be seen in part, but not by less than this.
constexpr std::size_t kFewestInPlace = 12;
/// Saturated share of the lit area in the photograph of white from which the photographs are refused.
constexpr double kMostSaturated = 0.05;

}  // namespace

/// What either method finds.
struct ProjectorStep::Decoded {
  BlobSize blobSize = BlobSize::kUsual;
  std::vector<PointPair> points;
  int shown = 0;
  double cameraScale = 0;
  double saturatedShare = 0;
  std::string hint;
  std::vector<PhotoProblem> problems;
  bool cutOff = false;

  static Decoded fromBlobs(std::vector<devices::Image8> photos, const BlobLayout& layout, const CameraMapping& camera) {
    const auto own = std::make_unique<PatternPhotos>();
    std::ranges::move(photos, own->begin());
    const DecodedBlobs blobs = decodeBlobs(*own, layout, camera);
    Decoded decoded{layout.size(),        {},         kBlobCount,     blobs.cameraScale,
                    blobs.saturatedShare, blobs.hint, blobs.problems, blobs.cutOff};
    for (const auto& blob : blobs.blobs) decoded.points.push_back({layout.centre(blob.id), blob.pointInUndistorted});
    return decoded;
  }

  static Decoded fromStripes(const std::vector<devices::Image8>& photos, devices::Size resolution,
                             const CameraMapping& camera) {
    const DenseSamples dense = decodeDense(photos, resolution, camera);
    Decoded decoded{{}, {}, dense.shown, dense.cameraScale, dense.saturatedShare, dense.hint, {}};
    for (const auto& sample : dense.samples) {
      decoded.points.push_back({sample.pointInProjector, sample.pointInUndistorted});
    }
    return decoded;
  }
};

struct ProjectorStep::Pending {
  const ProjectorConfig* config;
  std::size_t place;
  std::shared_future<Decoded> decoded;
};

std::vector<SeenProjector> ProjectorStep::observe(const std::vector<const ProjectorConfig*>& projectors) {
  std::vector<Pending> pending;
  const auto places = static_cast<std::size_t>(source_.placeCount());
  done_ = 0;
  total_ = 0;
  for (const auto* config : projectors) {
    total_ += static_cast<int>(places * patternsOf(method_, config->resolution).size());
  }
  for (std::size_t place = 0; place < places; ++place) decodePlace(place, projectors, pending);
  std::vector<SeenProjector> seen;
  for (const auto* config : projectors) {
    std::vector<Pending*> fromPlaces;
    for (auto& one : pending) {
      if (one.config == config) fromPlaces.push_back(&one);
    }
    if (fromPlaces.empty()) {
      progress_.warn("projector " + config->name + ": nothing was photographed of it; left out");
      continue;
    }
    SeenProjector projector = collect(*config, fromPlaces);
    if (!projector.views.empty()) seen.push_back(std::move(projector));
  }
  return seen;
}

void ProjectorStep::decodePlace(std::size_t place, const std::vector<const ProjectorConfig*>& projectors,
                                std::vector<Pending>& pending) {
  source_.choosePlace(static_cast<int>(place));
  const CameraMapping camera(camera_);
  for (const auto* config : projectors) {
    const int after = done_ + static_cast<int>(patternsOf(method_, config->resolution).size());
    if (source_.hasProjector(config->name)) {
      BlobSize blobSize{};
      auto photos = photograph(*config, blobSize);
      // One decoder at a time beside the camera: two cores, and a bounded number of photographs in memory.
      if (!pending.empty()) pending.back().decoded.wait();
      pending.push_back({config, place,
                         std::async(std::launch::async, [photos = std::move(photos), size = config->resolution,
                                                         method = method_, blobSize, camera]() mutable {
                           // Held here, not by the future: the photographs are many and large.
                           auto own = std::move(photos);
                           return method == Method::kBlobs
                                      ? Decoded::fromBlobs(std::move(own), BlobLayout(size, blobSize), camera)
                                      : Decoded::fromStripes(own, size, camera);
                         }).share()});
    }
    done_ = after;
  }
}

std::vector<devices::Image8> ProjectorStep::photograph(const ProjectorConfig& config, BlobSize& size) {
  std::vector<devices::Image8> photos;
  size = source_.blobSizeTaken(config.name).value_or(BlobSize::kUsual);
  const std::size_t total = patternsOf(method_, config.resolution).size();
  while (photos.size() < total) {
    const auto pattern = patternsOf(method_, config.resolution, size)[photos.size()];
    photos.push_back(source_.pattern(config.name, pattern));
    const std::string file = patternPath(config.name, pattern).string();
    if (photos.back().size() != camera_.size) {
      throw ProcedureError(file + ": not of the size that the camera was calibrated at");
    }
    progress_.advance(done_ + static_cast<int>(photos.size()), total_, file);
    // Places are tied by the points that they share, so those must be the same everywhere.
    const bool free = !source_.blobSizeTaken(config.name) && source_.placeCount() == 1;
    if (photos.size() == 2 && free) {
      size = blobSizeFor(config.resolution, cameraScaleOf(photos[0], photos[1], config.resolution));
    }
  }
  return photos;
}

std::string ProjectorStep::problemWith(const ProjectorConfig& config, const Decoded& decoded, std::size_t place) {
  const BlobLayout layout(config.resolution, decoded.blobSize);
  const std::string from = source_.placeCount() > 1 ? "place " + std::to_string(place + 1) + ": " : "";
  for (const auto& problem : decoded.problems) {
    std::string files;
    for (const Pattern pattern : problem.patterns) {
      files += (files.empty() ? "" : ", ") + patternPath(config.name, projected(pattern, layout)).string() + ".png";
    }
    const std::string text = from + files + ": " + problem.seen + "; " + problem.advice;
    if (problem.fatal) return text;
    // From one of several places part of a frame is all that can be expected.
    if (decoded.cutOff && source_.placeCount() > 1) continue;
    progress_.warn("projector " + config.name + ": " + text);
  }
  if (decoded.saturatedShare > kMostSaturated) {
    // Points may still be found, but where white is clipped their light cannot be divided by it.
    const auto white = patternsOf(method_, config.resolution)[1];
    return from + patternPath(config.name, white).string() +
           ".png is over-exposed: " + rounded(100 * decoded.saturatedShare, 0) +
           " % of the lit area is saturated; shorten the exposure until white stays below 85 %";
  }
  const auto found = decoded.points.size();
  const std::string what = from + std::to_string(found) + " of " + std::to_string(decoded.shown) +
                           (method_ == Method::kBlobs ? " blobs" : " points") + " found; " + decoded.hint;
  const auto fewest =
      source_.placeCount() > 1 ? kFewestInPlace : static_cast<std::size_t>(kFewestShare * decoded.shown);
  if (found < fewest || decoded.shown == 0) return what;
  if (!decoded.hint.empty() && decoded.problems.empty() && source_.placeCount() == 1) {
    progress_.warn("projector " + config.name + ": " + what);
  }
  return "";
}

SeenProjector ProjectorStep::collect(const ProjectorConfig& config, const std::vector<Pending*>& fromPlaces) {
  SeenProjector projector{&config, {}, 0};
  std::set<std::pair<double, double>> points;
  std::string problems;
  for (const Pending* pending : fromPlaces) {
    const Decoded& decoded = pending->decoded.get();
    projector.shown = std::max(projector.shown, decoded.shown);
    if (const std::string problem = problemWith(config, decoded, pending->place); !problem.empty()) {
      problems += (problems.empty() ? "" : "; ") + problem;
      continue;
    }
    for (const auto& point : decoded.points) points.emplace(point.source.x, point.source.y);
    projector.views.push_back({pending->place, decoded.points, decoded.cameraScale});
  }
  const bool enough = static_cast<double>(points.size()) >= kFewestShare * projector.shown;
  if (projector.views.empty() || !enough) {
    fail_(config.name, !problems.empty()
                           ? problems
                           : "only " + std::to_string(points.size()) + " of " + std::to_string(projector.shown) +
                                 " points were found from all places together; photograph it from a "
                                 "place that shows it whole");
    projector.views.clear();
  }
  return projector;
}

}  // namespace pixelflex::calib
