#include "calib/patterns/drift.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "calib/patterns/blob_fit.h"

namespace pixelflex::calib {
namespace {

constexpr double kFaintestBlob = 6;  // codes above its surroundings

/// Looks for blobs where the calibration says they are.
class DriftSearch {
 public:
  DriftSearch(const devices::Image8& photo, const BlobLayout& layout, const CameraMapping& camera,
              const ScreenView& screen, const ProjectorMapping& projector)
      : photo_(photo), layout_(layout), camera_(camera), screen_(screen), projector_(projector) {
    const glm::dvec2 step = layout.centre(kBlobColumns + 2) - layout.centre(1);
    reach_ = 0.5 * std::min(step.x, step.y);
  }

  /// Where the blob stands now, in the projector pixels of the calibration. None: not in the picture.
  [[nodiscard]] std::optional<std::optional<glm::dvec2>> find(int id) const {
    const auto inRaw = rawFromProjector(layout_.centre(id));
    if (!inRaw || !inside(*inRaw)) return std::nullopt;
    const auto samples = samplesAround(layout_.centre(id));
    if (samples.size() < 12) return std::optional<glm::dvec2>();
    const auto [darkest, brightest] = std::ranges::minmax(samples, {}, &LightSample::light);
    if (brightest.light - darkest.light < kFaintestBlob) return std::optional<glm::dvec2>();
    const auto fit = fitGaussian(near(samples, brightest.at),
                                 {brightest.at, layout_.sigma(), brightest.light - darkest.light, darkest.light});
    const bool plausible = fit && fit->amplitude > kFaintestBlob && fit->sigma < 3 * layout_.sigma() &&
                           glm::length(fit->centre - layout_.centre(id)) < reach_;
    return plausible ? std::optional(fit->centre) : std::optional<glm::dvec2>();
  }

 private:
  [[nodiscard]] bool inside(glm::dvec2 p) const {
    return p.x >= 0 && p.y >= 0 && p.x < photo_.width() && p.y < photo_.height();
  }
  [[nodiscard]] std::optional<glm::dvec2> rawFromProjector(glm::dvec2 pointInProjector) const {
    const auto inWall = projector_.wallFromProjector(pointInProjector);
    if (!inWall) return std::nullopt;
    return camera_.rawFromUndistorted(screen_.imageFromWall(*inWall));
  }
  [[nodiscard]] std::optional<glm::dvec2> projectorFromRaw(glm::dvec2 pointInRaw) const {
    const auto inWall = screen_.wallFromImage(camera_.undistortedFromRaw(pointInRaw));
    return inWall ? projector_.projectorFromWall(*inWall) : std::nullopt;
  }

  [[nodiscard]] std::vector<LightSample> samplesAround(glm::dvec2 centre) const {
    const glm::dvec2 middle = rawFromProjector(centre).value_or(glm::dvec2(0));
    const glm::dvec2 aside = rawFromProjector(centre + glm::dvec2(reach_, reach_)).value_or(middle);
    const double radius = 1.3 * glm::length(aside - middle) + 2;  // oblique cells are not square
    std::vector<LightSample> samples;
    for (int y = std::max(0, int(middle.y - radius)); y < std::min(photo_.height(), int(middle.y + radius)); ++y) {
      for (int x = std::max(0, int(middle.x - radius)); x < std::min(photo_.width(), int(middle.x + radius)); ++x) {
        const auto p = projectorFromRaw({x + 0.5, y + 0.5});
        if (!p || glm::length(*p - centre) > reach_) continue;
        samples.push_back({*p, (photo_.at(x, y, 0) + photo_.at(x, y, 1) + photo_.at(x, y, 2)) / 3.0});
      }
    }
    return samples;
  }

  [[nodiscard]] std::vector<LightSample> near(std::vector<LightSample> samples, glm::dvec2 centre) const {
    const double window = 3.2 * layout_.sigma();
    std::erase_if(samples, [&](const LightSample& s) { return glm::length(s.at - centre) > window; });
    return samples;
  }

  const devices::Image8& photo_;
  const BlobLayout& layout_;
  const CameraMapping& camera_;
  const ScreenView& screen_;
  const ProjectorMapping& projector_;
  double reach_ = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Drift measureDrift(const devices::Image8& photo, const BlobLayout& layout, const CameraMapping& camera,
                   const ScreenView& screen, const ProjectorMapping& projector) {
  const DriftSearch search(photo, layout, camera, screen, projector);
  Drift drift;
  std::vector<double> xs;
  std::vector<double> ys;
  double squares = 0;
  for (int id = 1; id <= kBlobCount; ++id) {
    const auto looked = search.find(id);
    if (!looked) continue;
    ++drift.expected;
    if (!*looked) continue;
    const glm::dvec2 moved = **looked - layout.centre(id);
    xs.push_back(moved.x);
    ys.push_back(moved.y);
    squares += glm::dot(moved, moved);
    drift.maximum = std::max(drift.maximum, glm::length(moved));
  }
  drift.found = static_cast<int>(xs.size());
  if (drift.found > 0) {
    drift.shift = {median(xs), median(ys)};
    drift.rms = std::sqrt(squares / drift.found);
  }
  return drift;
}

}  // namespace pixelflex::calib
