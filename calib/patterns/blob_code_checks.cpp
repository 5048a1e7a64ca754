#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "calib/patterns/blob_checks.h"

namespace pixelflex::calib {
namespace {

constexpr double kMovedAtAll = 0.1;  // camera pixels; spots of two good photographs differ by 0.01
constexpr double kMovedTooFar = 0.4;
constexpr double kFrameMoved = 0.2;  // by the edges of white, which are softer: 0.06
constexpr double kFrameMovedTooFar = 0.5;
constexpr double kOtherExposure = 1.25;
constexpr double kBlurred = 0.8;  // sharpness relative to the blobs photograph
constexpr std::size_t kFewestNumbered = 20;

std::string fixed(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// What a photograph may show instead of its own bit: another bit, or all blobs.
constexpr int kShowsAll = kCodeBits;

class CodeCheck {
 public:
  explicit CodeCheck(const BlobEvidence& evidence) : evidence_(evidence) {}

  std::vector<PhotoProblem> run() {
    if (evidence_.grid.spots.size() >= kFewestNumbered) checkWhatIsShown();
    checkSharpness();
    checkFrameMoved();
    checkMoved();
    checkExposure();
    return std::move(problems_);
  }

 private:
  [[nodiscard]] const CodePhoto& code(int bit) const { return evidence_.codes[static_cast<std::size_t>(bit)]; }

  /// Share of the numbered spots at which a photograph contradicts a picture.
  [[nodiscard]] double contradiction(int photo, int picture) const {
    int wrong = 0;
    for (const auto& spot : evidence_.grid.spots) {
      const bool lit = code(photo).ratio[spot.spot] > 0.5;
      const bool meant = picture == kShowsAll || ((spot.id >> picture) & 1) != 0;
      wrong += lit != meant ? 1 : 0;
    }
    return double(wrong) / double(evidence_.grid.spots.size());
  }

  /// The picture that a photograph agrees with when it is not its own.
  [[nodiscard]] int otherPicture(int photo) const {
    if (contradiction(photo, photo) < 0.2) return photo;
    for (int picture = 0; picture <= kShowsAll; ++picture) {
      if (contradiction(photo, picture) < 0.06) return picture;
    }
    return -1;
  }

  void checkWhatIsShown() {
    std::array<int, kCodeBits> shown{};
    for (int bit = 0; bit < kCodeBits; ++bit) shown[static_cast<std::size_t>(bit)] = otherPicture(bit);
    for (int bit = 0; bit < kCodeBits; ++bit) {
      const int picture = shown[static_cast<std::size_t>(bit)];
      if (picture == bit) {
        countDisagreement(bit);
      } else if (picture == kShowsAll) {
        add({bitPattern(bit)}, "it shows all blobs, not those of " + patternName(bitPattern(bit)),
            "photograph it again");
      } else if (picture < 0) {
        reportForeign(bit);
      } else if (shown[static_cast<std::size_t>(picture)] == bit) {
        if (bit < picture) {
          add({bitPattern(bit), bitPattern(picture)}, "each shows the picture of the other: swapped",
              "exchange the two");
        }
      } else {
        add({bitPattern(bit)}, "it shows the picture of " + patternName(bitPattern(picture)),
            "photograph it again while " + patternName(bitPattern(bit)) + " is shown");
      }
    }
    reportDisagreement();
  }

  void reportForeign(int bit) {
    const bool dark = code(bit).spots < 5;
    add({bitPattern(bit)},
        dark ? "hardly any light of this projector is in it"
             : fixed(100 * contradiction(bit, bit), 0) + " % of the blobs contradict it: not this projector's " +
                   patternName(bitPattern(bit)) + ", or the camera has moved",
        dark ? "photograph it again, the projector on and uncovered"
             : "photograph it again; if the camera was touched, photograph all of them again");
  }

  /// A few blobs that a person or a lamp changes: their neighbours tell which they are.
  void countDisagreement(int bit) {
    int count = 0;
    for (const auto& spot : evidence_.grid.spots) {
      const double light = 2 * code(bit).ratio[spot.spot] - 1;
      const bool meant = ((spot.id >> bit) & 1) != 0;
      if ((meant ? light : -light) > -0.2) continue;
      disagreementAt_ += spot.pointInRaw;
      ++count;
    }
    if (count > 0) disagreeing_.push_back(bitPattern(bit));
    disagreements_ += count;
  }

  void reportDisagreement() {
    if (disagreements_ == 0) return;
    const bool one = disagreements_ == 1;
    add(disagreeing_,
        std::to_string(disagreements_) + (one ? " blob is" : " blobs are") + " lit or dark against " +
            (one ? "its place" : "their places") + ", mostly " +
            placeInPhoto(disagreementAt_ / double(disagreements_), evidence_.photo) +
            " of the photograph: was somebody before the wall?",
        "used all the same, told apart by their neighbours", false);
  }

  /// White against blobs: where the blobs say that the frame ends.
  void checkFrameMoved() {
    const double distance = glm::length(evidence_.edges.shift);
    if (evidence_.edges.sides < 3 || distance < kFrameMoved) return;
    add({Pattern::kWhite, Pattern::kBlobs},
        "between them the camera, or the projector, has moved by " + fixed(distance, 1) + " camera pixels",
        "fix both, touch neither, and photograph everything again", distance >= kFrameMovedTooFar);
  }

  /// Exposures may differ without harm where only codes are read, but not between blobs and white.
  void checkExposure() {
    std::vector<Pattern> other;
    for (int bit = 0; bit < kCodeBits; ++bit) {
      if (std::abs(std::log(code(bit).brightness)) > std::log(kOtherExposure)) other.push_back(bitPattern(bit));
    }
    const std::string advice = "fix the exposure by hand and photograph this projector again";
    if (other.size() >= kCodeBits - 2) {
      add({Pattern::kBlobs}, "exposed differently from the code photographs", advice);
    } else if (!other.empty()) {
      add(other, "exposed differently from blobs", advice, false);
    }
  }

  [[nodiscard]] double moved(int bit) const { return code(bit).matched > 0.6 ? glm::length(code(bit).shift) : 0; }

  void checkMoved() {
    for (int bit = 0; bit < kCodeBits; ++bit) {
      if (moved(bit) < kMovedAtAll) continue;
      bool onwards = true;
      for (int later = bit; later < kCodeBits; ++later) onwards = onwards && moved(later) >= kMovedAtAll;
      const double most = moved(bit);
      const std::string distance = fixed(most, most < 2 ? 1 : 0) + " camera pixels";
      if (onwards) {
        add({bitPattern(bit)},
            "from this photograph on the camera, or the projector, has moved: blobs stand " + distance +
                " beside where blobs shows them",
            "fix both, touch neither, and photograph everything again", most >= kMovedTooFar);
        return;
      }
      add({bitPattern(bit)},
          "its blobs stand " + distance +
              " beside where the others show them: the camera has moved, or it belongs to "
              "another set",
          "photograph everything again without touching the camera", most >= kMovedTooFar);
    }
  }

  void checkSharpness() {
    int blurred = 0;
    int sharper = 0;
    for (int bit = 0; bit < kCodeBits; ++bit) {
      blurred += code(bit).sharpness < kBlurred ? 1 : 0;
      sharper += code(bit).sharpness > 1 / kBlurred ? 1 : 0;
    }
    if (sharper >= kCodeBits - 2) {
      add({Pattern::kBlobs}, "blurred: its blobs are flatter than those of the code photographs",
          "hold the camera still, focus on the wall, and photograph it again");
      return;
    }
    for (int bit = 0; bit < kCodeBits; ++bit) {
      if (code(bit).sharpness >= kBlurred) continue;
      // What tells the blobs apart may be unsharp; where they are is measured in another photograph.
      add({bitPattern(bit)},
          "blurred: its blobs are " + fixed(100 * code(bit).sharpness, 0) + " % as peaked as those of blobs",
          "hold the camera still and photograph it again", false);
    }
  }

  void add(std::vector<Pattern> patterns, std::string seen, std::string advice, bool fatal = true) {
    problems_.push_back({std::move(patterns), std::move(seen), std::move(advice), fatal});
  }

  const BlobEvidence& evidence_;
  std::vector<PhotoProblem> problems_;
  std::vector<Pattern> disagreeing_;
  int disagreements_ = 0;
  glm::dvec2 disagreementAt_{0, 0};  // sum, raw pixels
};

}  // namespace

std::vector<PhotoProblem> checkCodes(const BlobEvidence& evidence) {
  return CodeCheck(evidence).run();
}

}  // namespace pixelflex::calib
