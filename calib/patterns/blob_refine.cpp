#include "calib/patterns/blob_refine.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "calib/patterns/blob_fit.h"

namespace pixelflex::calib {
namespace {

class Refiner {
 public:
  Refiner(const devices::Image8& photo, const devices::ImageF& light, double peak, const devices::Image8& usable,
          const BlobLayout& layout, const CameraMapping& camera)
      : photo_(photo), light_(light), peak_(peak), usable_(usable), layout_(layout), camera_(camera) {}

  [[nodiscard]] std::optional<FittedBlob> fit(const GridSpot& spot, const Homography& cameraFromProjector) const {
    const Homography projectorFromCamera = cameraFromProjector.inverse();
    const glm::dvec2 start = projectorFromCamera.map(spot.pointInUndistorted);
    const Samples samples = samplesAround(spot, start, cameraFromProjector);
    const auto fit = fitGaussian(samples.light, {start, layout_.sigma(), peak_, 0});
    if (!fit || !plausible(*fit, start)) return std::nullopt;
    return FittedBlob{.blob = {spot.id, cameraFromProjector.map(fit->centre), spot.confidence, fit->error},
                      .pointInRaw = spot.pointInRaw,
                      .sigma = fit->sigma,
                      .amplitude = fit->amplitude,
                      .clipped = samples.clipped};
  }

 private:
  struct Samples {
    std::vector<LightSample> light;
    double clipped = 0;
  };

  [[nodiscard]] bool plausible(const GaussianFit& fit, glm::dvec2 start) const {
    const double sigma = layout_.sigma();
    return glm::length(fit.centre - start) < sigma && fit.sigma > 0.5 * sigma && fit.sigma < 2.5 * sigma &&
           fit.amplitude > 0.3 * peak_;
  }

  [[nodiscard]] Samples samplesAround(const GridSpot& spot, glm::dvec2 start,
                                      const Homography& cameraFromProjector) const {
    const Homography projectorFromCamera = cameraFromProjector.inverse();
    const double reach = 3.2 * layout_.sigma();
    glm::dvec2 low = spot.pointInRaw;
    glm::dvec2 high = spot.pointInRaw;
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
      const glm::dvec2 raw = camera_.rawFromUndistorted(cameraFromProjector.map(start + corner * reach));
      low = {std::min(low.x, raw.x), std::min(low.y, raw.y)};
      high = {std::max(high.x, raw.x), std::max(high.y, raw.y)};
    }
    Samples samples;
    int clipped = 0;
    for (int y = std::max(0, int(low.y)); y < std::min(light_.height(), int(high.y) + 1); ++y) {
      for (int x = std::max(0, int(low.x)); x < std::min(light_.width(), int(high.x) + 1); ++x) {
        if (usable_.at(x, y) == 0) continue;
        const glm::dvec2 p = projectorFromCamera.map(camera_.undistortedFromRaw({x + 0.5, y + 0.5}));
        if (glm::length(p - start) > reach) continue;
        if (saturated(x, y)) {
          ++clipped;
        } else {
          samples.light.push_back({p, light_.at(x, y)});
        }
      }
    }
    samples.clipped = clipped / std::max(1.0, clipped + double(samples.light.size()));
    return samples;
  }

  [[nodiscard]] bool saturated(int x, int y) const {
    return photo_.at(x, y, 0) >= kSaturatedCode || photo_.at(x, y, 1) >= kSaturatedCode ||
           photo_.at(x, y, 2) >= kSaturatedCode;
  }

  const devices::Image8& photo_;
  const devices::ImageF& light_;
  double peak_;
  const devices::Image8& usable_;
  const BlobLayout& layout_;
  const CameraMapping& camera_;
};

double medianError(const std::vector<FittedBlob>& blobs) {
  std::vector<double> errors;
  for (const auto& blob : blobs) errors.push_back(blob.blob.error);
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

/// Half a blob, or one in a shadow's edge, is no Gaussian: it fits much worse than the others.
void dropMisshapen(std::vector<FittedBlob>& blobs) {
  constexpr double kWorse = 4;
  constexpr double kNegligible = 0.02;  // projector pixels
  if (blobs.empty()) return;
  const double limit = std::max(kNegligible, kWorse * medianError(blobs));
  std::erase_if(blobs, [limit](const FittedBlob& blob) { return blob.blob.error > limit; });
}

}  // namespace

std::vector<FittedBlob> refineBlobs(const devices::Image8& photo, const devices::ImageF& light, double peak,
                                    const devices::Image8& usable, const Grid& grid, const BlobLayout& layout,
                                    const CameraMapping& camera) {
  const Refiner refiner(photo, light, peak, usable, layout, camera);
  std::vector<FittedBlob> fitted;
  for (const auto& spot : grid.spots) {
    if (auto blob = refiner.fit(spot, mapAround(spot.id, grid, layout))) fitted.push_back(*blob);
  }
  dropMisshapen(fitted);
  return fitted;
}

}  // namespace pixelflex::calib
