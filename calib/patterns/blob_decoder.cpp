#include "calib/patterns/blob_decoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/patterns/blob_checks.h"
#include "calib/patterns/blob_codes.h"
#include "calib/patterns/blob_grid.h"
#include "calib/patterns/blob_light.h"
#include "calib/patterns/blob_photo_checks.h"
#include "calib/patterns/blob_refine.h"

namespace pixelflex::calib {
namespace {

constexpr std::size_t kFewestSpots = 8;

class Decoder {
 public:
  Decoder(const PatternPhotoRefs& photos, const BlobLayout& layout, const CameraMapping& camera)
      : photos_(photos), layout_(layout), camera_(camera) {}

  DecodedBlobs run() {
    report(checkFiles(photos_));
    if (!samePhotoSizes()) return finish();
    const auto frame = findFrame(photos_);
    if (!frame) {
      if (!result_.unusable()) report({explainNoFrame(photos_)});
      return finish();
    }
    result_.saturatedShare = frame->saturatedShare;
    result_.cutOff = frame->cutOff;
    report(checkLight(photos_, *frame));
    measure(*frame);
    return finish();
  }

 private:
  [[nodiscard]] bool samePhotoSizes() const {
    return std::ranges::all_of(photos_, [this](const auto* photo) {
      return photo->channels() == 3 && photo->size() == photos_.front()->size();
    });
  }

  /// What follows from a fault that was named already is not said again.
  void report(const std::vector<PhotoProblem>& problems) {
    for (const auto& problem : problems) {
      if (!explained(problem)) result_.problems.push_back(problem);
    }
  }

  [[nodiscard]] bool explained(const PhotoProblem& problem) const {
    const auto touches = [](const PhotoProblem& one, Pattern pattern) {
      return std::ranges::find(one.patterns, pattern) != one.patterns.end();
    };
    return std::ranges::any_of(result_.problems, [&](const PhotoProblem& known) {
      // Without black and white nothing else can be judged.
      if (known.fatal && (touches(known, Pattern::kBlack) || touches(known, Pattern::kWhite))) return true;
      const bool same = std::ranges::any_of(problem.patterns, [&](Pattern one) { return touches(known, one); });
      return same && (known.fatal || !problem.fatal);
    });
  }

  void measure(const FrameLight& frame) {
    const auto& photo = *photos_[indexOf(Pattern::kBlobs)];
    const devices::ImageF light = relativeLight(photo, frame);
    const Spots spots = findSpots(light, frame);
    result_.located = static_cast<int>(spots.pointsInRaw.size());
    const double scale = std::sqrt(double(frame.area) / double(layout_.resolution().area()));
    CodePhotos codes;
    for (int bit = 0; bit < kCodeBits; ++bit) {
      const devices::ImageF own = relativeLight(*photos_[indexOf(bitPattern(bit))], frame);
      codes[static_cast<std::size_t>(bit)] = readCode(own, light, spots, frame, scale * layout_.sigma());
    }
    const Grid grid = numberSpots(spots, codes, layout_, camera_, frame.cell());
    std::vector<FittedBlob> blobs;
    FrameEdges edges;
    if (grid.spots.size() >= kFewestSpots) {
      edges = measureEdges(frame, grid, layout_);
      // White falls off there, and what is divided by it would rise.
      const double rim = std::min(1 + 3 * edges.blur, 2 * scale * layout_.sigma());
      blobs = refineBlobs(photo, light, spots.peak, withoutRim(frame, rim), grid, layout_, camera_);
      result_.cameraScale = scaleOf(grid);
    }
    for (const auto& blob : blobs) result_.blobs.push_back(blob.blob);
    const BlobEvidence evidence{layout_,     camera_, frame, spots, codes, grid, edges, blobs, result_.cameraScale,
                                photo.size()};
    if (checkFuller(evidence)) return;
    report(checkCodes(evidence));
    if (!result_.unusable()) report(checkBlobs(evidence));
    result_.hint = explainMissing(evidence);
  }

  [[nodiscard]] double scaleOf(const Grid& grid) const {
    const glm::dvec2 middle = layout_.centre(kBlobCount / 2 + kBlobColumns / 2);
    const glm::dvec2 step =
        grid.cameraFromProjector.map(middle + glm::dvec2(1, 0)) - grid.cameraFromProjector.map(middle);
    return std::hypot(step.x, step.y);
  }

  /// A code photograph with many more spots than the photograph of all: these two were exchanged.
  bool checkFuller(const BlobEvidence& evidence) {
    const auto fullest = std::ranges::max_element(evidence.codes, {}, &CodePhoto::spots);
    if (fullest->spots < 60 || fullest->spots * 3 < 4 * result_.located) return false;
    const Pattern bit = bitPattern(static_cast<int>(fullest - evidence.codes.begin()));
    const std::string counts = std::to_string(result_.located) + " and " + std::to_string(fullest->spots);
    report({{{Pattern::kBlobs, bit},
             "they show " + counts + " blobs: swapped?",
             "exchange the two, or photograph both again"}});
    return true;
  }

  DecodedBlobs finish() {
    std::ranges::stable_sort(result_.problems, {}, [](const PhotoProblem& problem) { return !problem.fatal; });
    if (result_.hint.empty() && result_.blobs.empty() && !result_.problems.empty()) {
      result_.hint = result_.problems.front().seen + "; " + result_.problems.front().advice;
    }
    return std::move(result_);
  }

  PatternPhotoRefs photos_;
  const BlobLayout& layout_;
  const CameraMapping& camera_;
  DecodedBlobs result_;
};

}  // namespace

bool DecodedBlobs::unusable() const {
  return std::ranges::any_of(problems, &PhotoProblem::fatal);
}

DecodedBlobs decodeBlobs(const PatternPhotos& photos, const BlobLayout& layout, const CameraMapping& camera) {
  PatternPhotoRefs refs{};
  std::ranges::transform(photos, refs.begin(), [](const auto& photo) { return &photo; });
  return Decoder(refs, layout, camera).run();
}

}  // namespace pixelflex::calib
