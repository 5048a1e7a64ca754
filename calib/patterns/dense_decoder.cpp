#include "calib/patterns/dense_decoder.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calib/patterns/dense_lattice.h"

namespace pixelflex::calib {
namespace {

constexpr double kFaintestLight = 4;  // codes between black and white below which nothing can be measured

constexpr double kLeastInOnePiece = 0.6;  // of the points found; a person before the wall takes fewer away
constexpr double kMostShift = 0.06;       // of the period

// Shares of the lit pixels. Somebody who walks by spoils some, a photograph of another pattern most.
constexpr double kNoticeablyContradicting = 0.1;
constexpr double kHopelesslyContradicting = 0.3;

const char* const kContradiction =
    "the photographs of stripes contradict each other: was one taken of another pattern, or the camera moved?";

class Decoder {
 public:
  Decoder(const std::vector<devices::Image8>& photos, devices::Size resolution, const CameraMapping& camera)
      : photos_(photos), layout_(resolution), camera_(camera) {
    assert(photos.size() == DenseOrder(layout_).count);
    result_.shown = layout_.columns() * layout_.rows();
  }

  DenseSamples run() {
    if (!samePhotoSizes()) return failed("the photographs differ in size: take all with one camera and one setting");
    const FrameLight light = measureFrameLight(photos_[DenseOrder::kBlack], photos_[DenseOrder::kWhite]);
    if (light.full < kFaintestLight) return failed(darkHint(light));
    DensePixels pixels = readPixels(photos_, layout_, light);
    result_.saturatedShare = share(pixels.saturated, pixels.lit);
    const double contradicting = share(pixels.contradicting, pixels.lit);
    if (contradicting > kHopelesslyContradicting || cameraMoved(pixels)) return failed(hintFor(pixels, true));
    keepContinuous(pixels, layout_);
    result_.cameraScale = cameraScaleOf(pixels);
    if (result_.cameraScale > 0) {
      DenseLattice lattice = fitLattice(pixels, result_.cameraScale, layout_, camera_);
      // Pieces that do not fit together: none of them can be trusted.
      if (keepLargestPart(lattice, layout_) < kLeastInOnePiece) return failed(hintFor(pixels, true));
      collect(lattice);
    }
    const bool complete = static_cast<int>(result_.samples.size()) == result_.shown;
    if (!complete || contradicting > kNoticeablyContradicting) result_.hint = hintFor(pixels, false);
    return result_;
  }

 private:
  DenseSamples failed(const std::string& hint) {
    result_.hint = hint;
    return result_;
  }

  [[nodiscard]] bool samePhotoSizes() const {
    return std::ranges::all_of(
        photos_, [this](const auto& photo) { return photo.channels() == 3 && photo.size() == photos_.front().size(); });
  }

  [[nodiscard]] bool cameraMoved(const DensePixels& pixels) const {
    return std::max(std::abs(pixels.shift.x), std::abs(pixels.shift.y)) > kMostShift * layout_.x().period();
  }

  [[nodiscard]] static double share(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
  }

  [[nodiscard]] static std::string darkHint(const FrameLight& light) {
    if (light.blackMean > light.whiteMean + 1) {
      return "the photograph of black is brighter than the photograph of white: were they swapped?";
    }
    return "the photograph of white is no brighter than the one of black: is the projector on, uncovered and in the "
           "camera's view, and the exposure long enough?";
  }

  void collect(const DenseLattice& lattice) {
    for (int row = 0; row < layout_.rows(); ++row) {
      for (int column = 0; column < layout_.columns(); ++column) {
        const auto& found = lattice[static_cast<std::size_t>(row) * static_cast<std::size_t>(layout_.columns()) +
                                    static_cast<std::size_t>(column)];
        if (found) result_.samples.push_back({layout_.point(column, row), found->pointInUndistorted});
      }
    }
  }

  /// The most telling cause first.
  [[nodiscard]] std::string hintFor(const DensePixels& pixels, bool nothingFits) const {
    constexpr double kMostSaturated = 0.05;
    constexpr double kMostFaint = 0.3;
    if (result_.saturatedShare > kMostSaturated) {
      return "the photograph of white is over-exposed: shorten the exposure until white stays below 85 %";
    }
    if (nothingFits || share(pixels.contradicting, pixels.lit) > kNoticeablyContradicting) return kContradiction;
    if (pixels.cutOff) {
      return "part of the projector's frame lies outside the photograph: move the camera back or turn it";
    }
    if (share(pixels.faint, pixels.lit) > kMostFaint) {
      return "the stripes are hardly visible: is the picture in focus, the camera close enough, and nothing standing "
             "before the wall?";
    }
    return "part of the frame is hidden, unsharp or too dark";
  }

  const std::vector<devices::Image8>& photos_;
  DenseLayout layout_;
  const CameraMapping& camera_;
  DenseSamples result_;
};

}  // namespace

DenseSamples decodeDense(const std::vector<devices::Image8>& photos, devices::Size resolution,
                         const CameraMapping& camera) {
  return Decoder(photos, resolution, camera).run();
}

}  // namespace pixelflex::calib
