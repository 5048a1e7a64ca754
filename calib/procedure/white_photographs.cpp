#include "calib/procedure/white_photographs.h"

#include <algorithm>
#include <cmath>

#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {
namespace {

class WhitePhotographer {
 public:
  WhitePhotographer(const Calibration& calibration, Method method, int nodesAcross, Photographs& source)
      : calibration_(calibration), method_(method), nodesAcross_(nodesAcross), source_(source) {
    for (const auto& projector : calibration.projectors) mappings_.emplace_back(projector);
  }

  std::vector<LightField> photograph(Progress& progress) {
    const std::vector<int> places = bestPlaces();
    std::vector<LightField> fields(mappings_.size());
    int done = 0;
    for (int place = 0; place < source_.placeCount(); ++place) {
      if (std::ranges::find(places, place) == places.end()) continue;
      source_.choosePlace(place);
      for (std::size_t i = 0; i < mappings_.size(); ++i) {
        if (places[i] != place) continue;
        fields[i] = photographOne(i, viewFrom(place));
        progress.advance(++done, static_cast<int>(mappings_.size()), calibration_.projectors[i].name + " white");
      }
    }
    return fields;
  }

 private:
  [[nodiscard]] ScreenView viewFrom(int place) const {
    if (place == 0) return ScreenView(*calibration_.surface);
    const auto further = static_cast<std::size_t>(place) - 1;
    if (further < calibration_.places.size()) return ScreenView(calibration_.places[further]);
    throw ProcedureError("the wall was measured from fewer camera places: photograph it from the same ones");
  }

  /// How much of a frame lies in the camera's picture, 0..1.
  [[nodiscard]] double seenShare(std::size_t i, const ScreenView& view) const {
    constexpr int kSteps = 12;
    const CameraMapping camera(*calibration_.camera);
    const devices::Size frame = mappings_[i].resolution();
    const devices::Size picture = calibration_.camera->size;
    int seen = 0;
    for (int k = 0; k < kSteps * kSteps; ++k) {
      const glm::dvec2 part((k % kSteps + 0.5) / kSteps, (static_cast<int>(k / kSteps) + 0.5) / kSteps);
      const auto inWall = mappings_[i].wallFromProjector({part.x * frame.width, part.y * frame.height});
      if (!inWall) continue;
      const glm::dvec2 raw = camera.rawFromUndistorted(view.imageFromWall(*inWall));
      if (raw.x > 0 && raw.y > 0 && raw.x < picture.width && raw.y < picture.height) ++seen;
    }
    return double(seen) / (kSteps * kSteps);
  }

  [[nodiscard]] std::vector<int> bestPlaces() const {
    std::vector<int> best(mappings_.size(), -1);
    std::vector<double> most(mappings_.size(), 0);
    for (int place = 0; place < source_.placeCount(); ++place) {
      source_.choosePlace(place);
      const ScreenView view = viewFrom(place);
      for (std::size_t i = 0; i < mappings_.size(); ++i) {
        if (!source_.hasProjector(calibration_.projectors[i].name)) continue;
        const double share = seenShare(i, view);
        if (share <= most[i]) continue;
        most[i] = share;
        best[i] = place;
      }
    }
    for (std::size_t i = 0; i < best.size(); ++i) {
      if (best[i] >= 0) continue;
      throw ProcedureError("projector " + calibration_.projectors[i].name +
                           ": no photograph of its white; the light cannot be matched without it");
    }
    return best;
  }

  [[nodiscard]] LightField photographOne(std::size_t i, const ScreenView& view) {
    const auto& projector = calibration_.projectors[i];
    const auto patterns = patternsOf(method_, projector.resolution);
    const auto black = source_.pattern(projector.name, patterns[0]);
    const auto white = source_.pattern(projector.name, patterns[1]);
    if (black.size() != calibration_.camera->size || white.size() != black.size()) {
      throw ProcedureError(patternPath(projector.name, patterns[1]).string() +
                           ": not of the size that the camera was calibrated at");
    }
    const double rows = double(nodesAcross_) * projector.resolution.height / projector.resolution.width;
    const devices::Size lattice{nodesAcross_, std::max(2, static_cast<int>(std::lround(rows)))};
    return measureLight(black, white, mappings_[i], view, CameraMapping(*calibration_.camera), lattice);
  }

  const Calibration& calibration_;
  Method method_;
  int nodesAcross_;
  Photographs& source_;
  std::vector<ProjectorMapping> mappings_;
};

}  // namespace

std::vector<LightField> photographWhite(const Calibration& calibration, Method method, int nodesAcross,
                                        Photographs& source, Progress& progress) {
  return WhitePhotographer(calibration, method, nodesAcross, source).photograph(progress);
}

}  // namespace pixelflex::calib
