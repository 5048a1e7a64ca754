#include "calib/patterns/blob_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

namespace pixelflex::calib {
namespace {

constexpr int kMostMissing = 40;
constexpr double kNominalGamma = 2.2;  // that blobs are drawn for
constexpr double kPeak = 0.9;          // of a blob's codes
constexpr double kBlurred = 0.5;       // sigma of the blur, of the blobs': said
constexpr double kTooBlurred = 0.75;   // refused: centres are off by a fifth of a pixel and more
constexpr double kUnsure = 0.07;       // projector pixels that noise moves a centre by: said
constexpr double kTooUnsure = 0.1;     // refused
constexpr double kMostClippedBlobs = 0.5;

std::string fixed(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

double medianOf(const std::vector<FittedBlob>& blobs, const auto& value) {
  std::vector<double> values;
  for (const auto& blob : blobs) values.push_back(value(blob));
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class BlobCheck {
 public:
  explicit BlobCheck(const BlobEvidence& evidence) : evidence_(evidence) {
    present_.fill(false);
    for (const auto& blob : evidence.blobs) present_[static_cast<std::size_t>(blob.blob.id)] = true;
  }

  std::vector<PhotoProblem> run() {
    if (evidence_.blobs.size() >= 8) {
      checkNoise();
      checkBlur();
      checkClipped();
    }
    checkMissing();
    return std::move(problems_);
  }

 private:
  void checkNoise() {
    const double error = std::sqrt(2) * medianOf(evidence_.blobs, [](const auto& blob) { return blob.blob.error; });
    if (error < kUnsure) return;
    const bool coarse = evidence_.cameraScale * evidence_.layout.sigma() < 1.2;
    const std::string unsure = "blobs are found to " + fixed(error, 2) + " projector pixels only";
    if (coarse) {
      add({Pattern::kBlobs}, "the blobs are too small in it: " + unsure,
          "move the camera closer or use one with more pixels", error >= kTooUnsure);
      return;
    }
    add({Pattern::kBlobs},
        "too dark or too noisy: white is " + fixed(evidence_.frame.level, 0) + " codes of 255 above black, and " +
            unsure,
        "lengthen the exposure of all photographs until white reaches about 200 codes", error >= kTooUnsure);
  }

  /// Blur of the blobs themselves, in parts of their width. A blob drawn for gamma 2.2 has an amplitude of 0.9^gamma
  /// and a width that goes with 1/sqrt(gamma) at another gamma, so their product tells gamma, and the width the blur.
  [[nodiscard]] double blurOfBlobs() const {
    const double width =
        medianOf(evidence_.blobs, [](const auto& blob) { return blob.sigma; }) / evidence_.layout.sigma();
    const double light = width * width * medianOf(evidence_.blobs, [](const auto& blob) { return blob.amplitude; });
    double gamma = kNominalGamma;
    for (int i = 0; i < 40; ++i) gamma = std::clamp(kNominalGamma * std::pow(kPeak, gamma) / light, 0.5, 4.0);
    return std::sqrt(std::max(0.0, width * width * gamma / kNominalGamma - 1));
  }

  void checkBlur() {
    const double blobs = blurOfBlobs();
    const double white = evidence_.edges.blur / (evidence_.cameraScale * evidence_.layout.sigma());
    if (std::max(blobs, white) < kBlurred) return;
    const std::string cure = "focus the camera and the projector on the wall, hold the camera still, and photograph ";
    if (blobs < kBlurred) {
      add({Pattern::kWhite},
          "blurred: the edges of its frame are " + fixed(2 * evidence_.edges.blur, 0) + " camera pixels wide",
          cure + "it again", white >= kTooBlurred);
      return;
    }
    add({Pattern::kBlobs},
        "blurred: blobs are " + fixed(std::sqrt(1 + blobs * blobs), 1) + " times as wide as they were projected",
        cure + "all again", std::max(blobs, white) >= kTooBlurred);
  }

  void checkClipped() {
    glm::dvec2 sum{0, 0};
    int count = 0;
    for (const auto& blob : evidence_.blobs) {
      if (blob.clipped < 0.02) continue;
      sum += blob.pointInRaw;
      ++count;
    }
    if (count < 5) return;
    add({Pattern::kBlobs},
        "over-exposed: " + std::to_string(count) + " blobs are clipped, mostly " +
            placeInPhoto(sum / double(count), evidence_.photo) + " of the photograph",
        "shorten the exposure of all photographs until white stays below 85 %",
        count > kMostClippedBlobs * double(evidence_.blobs.size()));
  }

  void checkMissing() {
    const int missing = kBlobCount - static_cast<int>(evidence_.blobs.size());
    if (missing == 0) return;
    std::string seen = std::to_string(missing) + " of " + std::to_string(kBlobCount) + " blobs are not seen";
    const std::string where = placeOfMissing();
    if (!where.empty()) seen += ", mostly " + where + " of the photograph";
    const auto side = std::ranges::find_if(sides(), [&](const Side& one) { return seenAlong(one) < kFewestAlong; });
    const bool open = side != sides().end();
    if (open) seen += "; hardly one along the frame's " + side->name + ", beyond which its map is a guess";
    // Where the photograph ends another one, from elsewhere, may show the rest: for the caller to judge. Where white is
    // dark as well the screen ends, and the guess is about nothing that anybody sees.
    const bool tooMany =
        !evidence_.frame.cutOff && (missing > kMostMissing || (open && litAlong(*side) >= kBlobColumns / 2));
    std::string advice = explainMissing(evidence_);
    if (!tooMany && missing < kBlobCount) advice += "; goes on with the other " + std::to_string(kBlobCount - missing);
    add({Pattern::kBlobs}, seen, advice, tooMany);
  }

  [[nodiscard]] glm::dvec2 expectedInRaw(int id) const {
    const auto there = mapAround(id, evidence_.grid, evidence_.layout).map(evidence_.layout.centre(id));
    return evidence_.camera.rawFromUndistorted(there);
  }

  /// Where the missing blobs would be in the photograph.
  [[nodiscard]] std::string placeOfMissing() const {
    if (evidence_.grid.spots.size() < 8) return "";
    glm::dvec2 sum{0, 0};
    int count = 0;
    for (int id = 1; id <= kBlobCount; ++id) {
      if (present_[static_cast<std::size_t>(id)]) continue;
      sum += expectedInRaw(id);
      ++count;
    }
    return placeInPhoto(sum / double(count), evidence_.photo);
  }

  /// An outer row or column of blobs.
  struct Side {
    std::string name;
    int first;  // blob's id
    int last;
    int step;
  };
  static constexpr int kFewestAlong = 2;

  [[nodiscard]] static const std::array<Side, 4>& sides() {
    static const std::array<Side, 4> kSides = {Side{"top", 1, kBlobColumns, 1},
                                               Side{"bottom", kBlobCount - kBlobColumns + 1, kBlobCount, 1},
                                               Side{"left side", 1, kBlobCount - kBlobColumns + 1, kBlobColumns},
                                               Side{"right side", kBlobColumns, kBlobCount, kBlobColumns}};
    static_assert(kBlobColumns == kBlobRows);
    return kSides;
  }
  [[nodiscard]] int seenAlong(const Side& side) const {
    int count = 0;
    for (int id = side.first; id <= side.last; id += side.step) count += present_[static_cast<std::size_t>(id)] ? 1 : 0;
    return count;
  }
  [[nodiscard]] int litAlong(const Side& side) const {
    if (evidence_.grid.spots.size() < 8) return 0;
    int count = 0;
    for (int id = side.first; id <= side.last; id += side.step) {
      const glm::dvec2 raw = expectedInRaw(id);
      const bool inside = raw.x >= 0 && raw.y >= 0 && raw.x < evidence_.photo.width && raw.y < evidence_.photo.height;
      if (inside && evidence_.frame.mask.at(static_cast<int>(raw.x), static_cast<int>(raw.y)) != 0) ++count;
    }
    return count;
  }

  void add(std::vector<Pattern> patterns, std::string seen, std::string advice, bool fatal) {
    problems_.push_back({std::move(patterns), std::move(seen), std::move(advice), fatal});
  }

  const BlobEvidence& evidence_;
  std::array<bool, kBlobCount + 1> present_{};
  std::vector<PhotoProblem> problems_;
};

}  // namespace

std::vector<PhotoProblem> checkBlobs(const BlobEvidence& evidence) {
  return BlobCheck(evidence).run();
}

std::string explainMissing(const BlobEvidence& evidence) {
  const std::size_t found = evidence.blobs.size();
  const std::size_t located = evidence.spots.pointsInRaw.size();
  if (found == std::size_t{kBlobCount}) return "";
  const double sigma =
      evidence.layout.sigma() * std::sqrt(double(evidence.frame.area) / double(evidence.layout.resolution().area()));
  if (evidence.frame.saturatedShare > 0.05) {
    return "the photograph of white is over-exposed: shorten the exposure until white stays below 85 %";
  }
  if (evidence.frame.cutOff) {
    return "part of the projector's frame lies outside the photograph: move the camera back or turn it";
  }
  if (sigma < 1.2) {
    return "the blobs are too small in the photograph: move the camera closer or use one with more pixels";
  }
  if (located < kBlobCount / 2) {
    return "few blobs are visible: is the picture in focus, and is nothing standing before the wall?";
  }
  if (found < kBlobCount * 9 / 10 && located >= kBlobCount * 9 / 10) {
    return "the code photographs contradict each other: was one taken of another pattern, or the camera moved?";
  }
  return "somebody or something stands before the wall, or they are unsharp";
}

}  // namespace pixelflex::calib
