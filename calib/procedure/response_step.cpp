#include "calib/procedure/response_step.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "calib/estimate/camera_transfer.h"
#include "calib/estimate/projector_response.h"
#include "calib/patterns/response_pattern.h"
#include "calib/procedure/camera_places.h"
#include "calib/procedure/frame_border.h"
#include "calib/procedure/frame_patch.h"
#include "calib/procedure/patch_photographer.h"
#include "calib/procedure/procedure_error.h"
#include "calib/store/readings_file.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

constexpr int kFirstChartStop = -2;  // powers of two of the usual exposure
constexpr int kLastChartStop = 6;

class ResponseMeter {
 public:
  ResponseMeter(const Wall& wall, const Calibration& calibration, const std::set<std::string>& only,
                Photographs& source, Progress& progress)
      : wall_(wall), calibration_(calibration), source_(source), progress_(progress) {
    for (const auto& projector : calibration.projectors) {
      const auto config = std::ranges::find(wall.projectors, projector.name, &ProjectorConfig::name);
      const bool wanted = config != wall.projectors.end() && config->gammaByCamera;
      if (wanted && (only.empty() || only.contains(projector.name))) wanted_.push_back(&projector);
    }
  }

  ResponseResult measure(const ResponseFailure& fail) {
    ResponseResult result;
    if (wanted_.empty()) return result;
    result.camera = measureCamera();
    const CameraResponse camera = result.camera ? *result.camera : cameraResponse(wall_.camera, std::nullopt);
    for (const auto* projector : wanted_) {
      const std::string& name = projector->name;
      try {
        result.responses[name] = measureOne(*projector, camera);
      } catch (const LevelError& error) {
        const auto level = levelPattern(projector->resolution, error.channel(), error.code());
        fail(name, patternPath(name, level).string() + ": " + error.what());
      } catch (const EstimateError& error) {
        fail(name, error.what());
      }
    }
    return result;
  }

 private:
  /// Where the camera sees most of it and, if they exist already, photographs of this pattern were taken.
  [[nodiscard]] std::optional<int> bestPlace(const ProjectorCalibration& projector, const std::string& pattern) {
    const ProjectorMapping mapping(projector);
    std::optional<int> best;
    double most = 0;
    for (int place = 0; place < source_.placeCount(); ++place) {
      const double share = seenShare(mapping, viewFromPlace(calibration_, place), *calibration_.camera);
      if (share <= most) continue;
      if (!source_.exposureRange() && !hasPhotographs(place, projector.name, pattern)) continue;
      most = share;
      best = place;
    }
    return best;
  }

  [[nodiscard]] bool hasPhotographs(int place, const std::string& projector, const std::string& pattern) {
    source_.choosePlace(place);
    return source_.hasExposures(projector, pattern);
  }

  /// None where it is stated, or counts as linear for want of photographs.
  [[nodiscard]] std::optional<CameraResponse> measureCamera() {
    if (wall_.camera.transfer) return std::nullopt;
    for (const auto* projector : wanted_) {
      const auto chart = responseChart(projector->resolution);
      const auto place = bestPlace(*projector, chart.name);
      if (!place) continue;
      source_.choosePlace(*place);
      const std::string path = patternPath(projector->name, chart).string();
      try {
        const auto photos = source_.exposureRange() ? exposeChart(projector->name, chart) : takenChart(projector->name);
        return nearestStandard(estimateCameraResponse(photos));
      } catch (const EstimateError& error) {
        throw ProcedureError("gamma: " + path + ": " + error.what());
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<ExposedPhoto> exposeChart(const std::string& projector, const ProjectedPattern& chart) {
    const auto [shortest, longest] = *source_.exposureRange();
    const auto [width, height] = calibration_.camera->size;
    std::vector<ExposedPhoto> photos;
    for (int stop = kFirstChartStop; stop <= kLastChartStop; ++stop) {
      const double seconds = source_.usualExposure() * std::exp2(stop);
      if (seconds < shortest || seconds > longest) continue;
      auto shot = source_.exposed(projector, chart, seconds, {0, 0, width, height});
      photos.push_back({shot.seconds.value_or(seconds), std::move(shot.photo)});
      progress_.advance(stop - kFirstChartStop + 1, kLastChartStop - kFirstChartStop + 1, projector + " chart");
    }
    return photos;
  }

  [[nodiscard]] std::vector<ExposedPhoto> takenChart(const std::string& projector) {
    std::vector<ExposedPhoto> photos;
    for (auto& shot : source_.exposures(projector, responseChart({64, 64}).name)) {
      if (!shot.seconds) {
        throw CaptureError(shot.name + ": its exposure is not told: add it to the name, as in response-chart@1_60.jpg");
      }
      photos.push_back({*shot.seconds, std::move(shot.photo)});
    }
    return photos;
  }

  [[nodiscard]] MeasuredResponse measureOne(const ProjectorCalibration& projector, const CameraResponse& camera) {
    const auto place = bestPlace(projector, levelPattern(projector.resolution, 0, 255).name);
    if (!place) throw EstimateError(missing(projector));
    source_.choosePlace(*place);
    const auto patch =
        FramePatch::of(ProjectorMapping(projector), viewFromPlace(calibration_, *place), *calibration_.camera);
    if (!patch) throw EstimateError("the middle of its picture is not wholly seen by the camera");
    PatchPhotographer photographer(source_, projector.name, *patch, calibration_.camera->size, camera);
    const Photographed seen = photographAll(projector, photographer, borderOf(projector, *place));
    const ProjectorResponse response = projectorResponse(seen.series);
    double squares = camera.error * camera.error;
    for (const double error : response.error) squares += error * error / 3;
    return {response.curve, std::sqrt(squares), response.leak ? response.leak : seen.leak};
  }

  [[nodiscard]] FrameBorder borderOf(const ProjectorCalibration& projector, int place) const {
    std::vector<ProjectorMapping> others;
    for (const auto& other : calibration_.projectors) {
      if (&other != &projector) others.emplace_back(other);
    }
    return {ProjectorMapping(projector), others, viewFromPlace(calibration_, place), *calibration_.camera};
  }

  [[nodiscard]] static std::string missing(const ProjectorCalibration& projector) {
    const auto level = levelPattern(projector.resolution, 0, 255);
    return "gamma: camera, but there is no photograph " + patternPath(projector.name, level).string() +
           " (.png or .jpg); pixelflex calibrate WALL --patterns DIR tells what to photograph";
  }

  struct Photographed {
    ResponseSeries series;
    std::optional<double> leak;  // as the border of the frame tells it
  };

  [[nodiscard]] Photographed photographAll(const ProjectorCalibration& projector, PatchPhotographer& photographer,
                                           const FrameBorder& border) {
    Photographed all;
    std::vector<devices::ImageF> full;
    for (int channel = 0; channel < 3; ++channel) {
      auto& levels = all.series.levels.at(static_cast<std::size_t>(channel));
      full.push_back(photographChannel(projector, channel, photographer, border.region(), levels));
    }
    const auto black = photographer.see(responseBlackPattern(projector.resolution), border.region());
    tell(projector.name + " black");
    all.series.black = black.patch;
    all.leak = border.leak(black.picture, whiteAbove(black.picture, full));
    if (all.leak && !tellsLeak(all.series, *all.leak)) all.leak.reset();
    if (source_.hasExposures(projector.name, ambientName())) all.series.ambient = photographer.lightOf(ambientName());
    return all;
  }

  /// Whether black was exposed long enough to be told from nothing.
  static bool tellsLeak(const ResponseSeries& series, double leak) {
    constexpr double kLargestDeviation = 0.15;
    constexpr double kFaint = 3e-5;  // of white: less than this matters to nobody
    for (std::size_t c = 0; c < 3; ++c) {
      double white = 0;
      for (const auto& levels : series.levels) white += levels.back().patch.light.at(c) - series.black.light.at(c);
      if (series.black.deviation.at(c) > (kLargestDeviation * leak + kFaint) * white) return false;
    }
    return true;
  }

  /// Its levels, and the whole picture of the full one.
  [[nodiscard]] devices::ImageF photographChannel(const ProjectorCalibration& projector, int channel,
                                                  PatchPhotographer& photographer, const PictureRegion& region,
                                                  std::vector<LevelLight>& levels) {
    photographer.beginBright();
    auto full = photographer.see(levelPattern(projector.resolution, channel, 255), region);
    levels.push_back({255, full.patch});
    auto codes = responseLevels();
    for (auto code = codes.rbegin() + 1; code != codes.rend(); ++code) {
      const auto pattern = levelPattern(projector.resolution, channel, *code);
      levels.push_back({*code, photographer.light(pattern)});
      tell(projector.name + " " + pattern.name);
    }
    std::ranges::reverse(levels);
    return std::move(full.picture);
  }

  void tell(const std::string& what) {
    progress_.advance(++told_, static_cast<int>(wanted_.size() * (3 * (responseLevels().size() - 1) + 1)), what);
  }

  /// Full red, green and blue, each above black.
  static devices::ImageF whiteAbove(const devices::ImageF& black, const std::vector<devices::ImageF>& full) {
    devices::ImageF white(black.size(), black.channels());
    for (const auto& field : full) {
      for (std::size_t i = 0; i < white.samples().size(); ++i) {
        white.samples()[i] += field.samples()[i] - black.samples()[i];
      }
    }
    return white;
  }

  const Wall& wall_;
  const Calibration& calibration_;
  Photographs& source_;
  Progress& progress_;
  std::vector<const ProjectorCalibration*> wanted_;
  int told_ = 0;  // of its progress
};

}  // namespace

ResponseResult measureResponses(const Wall& wall, const Calibration& calibration, const std::set<std::string>& only,
                                Photographs& source, Progress& progress, const ResponseFailure& fail) {
  return ResponseMeter(wall, calibration, only, source, progress).measure(fail);
}

CameraResponse cameraResponse(const CameraSource& camera, const std::optional<std::string>& file) {
  if (camera.transfer) return *camera.transfer == Transfer::kLinear ? linearCamera() : srgbCamera();
  if (!file) return linearCamera();
  const Readings readings = readReadings(readStoreFile(*file), *file);
  if (!readings.problems.empty()) throw StoreError(readings.problems);
  return {.light = readings.light};
}

double typicalError(const std::map<std::string, MeasuredResponse>& responses) {
  double squares = 0;
  for (const auto& [name, response] : responses) squares += response.error * response.error;
  return responses.empty() ? 0 : std::sqrt(squares / static_cast<double>(responses.size()));
}

std::string formatCameraResponse(const CameraResponse& camera) {
  return formatReadings({camera.light});
}

}  // namespace pixelflex::calib
