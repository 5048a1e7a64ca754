#include "calib/patterns/blob_photo_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace pixelflex::calib {
namespace {

using devices::Image8;

/// Share of white's lit area that may be saturated.
constexpr double kMostSaturated = 0.05;

std::string sizeText(devices::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}
std::string whole(double value) {
  return std::to_string(std::lround(value));
}

/// A photograph of another size than most.
std::vector<PhotoProblem> checkSizes(const PatternPhotoRefs& photos) {
  std::map<std::pair<int, int>, std::vector<Pattern>> bySize;
  for (const Pattern pattern : allPatterns()) {
    const auto& photo = *photos[indexOf(pattern)];
    bySize[{photo.width(), photo.height()}].push_back(pattern);
  }
  if (bySize.size() == 1) return {};
  const auto usual = std::ranges::max_element(bySize, {}, [](const auto& entry) { return entry.second.size(); });
  std::vector<PhotoProblem> problems;
  for (const auto& [size, patterns] : bySize) {
    if (size == usual->first) continue;
    problems.push_back({patterns,
                        sizeText({size.first, size.second}) + " pixels, while the others have " +
                            sizeText({usual->first.first, usual->first.second}),
                        "take all photographs with one camera and one setting"});
  }
  return problems;
}

std::vector<PhotoProblem> checkSame(const PatternPhotoRefs& photos) {
  std::vector<PhotoProblem> problems;
  std::vector<Pattern> seen;
  for (const Pattern pattern : allPatterns()) {
    const auto same =
        std::ranges::find_if(seen, [&](Pattern other) { return *photos[indexOf(other)] == *photos[indexOf(pattern)]; });
    if (same != seen.end()) {
      problems.push_back({{*same, pattern},
                          "one and the same photograph under two names",
                          "photograph each picture for itself, and check which of the two this is"});
    }
    seen.push_back(pattern);
  }
  return problems;
}

/// Black must be the darkest of all.
std::vector<PhotoProblem> checkBlack(const PatternPhotoRefs& photos) {
  constexpr int kStep = 3;
  Pattern darkest = Pattern::kBlack;
  std::array<double, kPatternCount> bright{};
  for (const Pattern pattern : allPatterns()) {
    bright[indexOf(pattern)] = percentile(sampledBrightness(*photos[indexOf(pattern)], kStep), 0.999);
    if (bright[indexOf(pattern)] < bright[indexOf(darkest)]) darkest = pattern;
  }
  const double range = *std::ranges::max_element(bright) - bright[indexOf(darkest)];
  const double more = bright[indexOf(Pattern::kBlack)] - bright[indexOf(darkest)];
  if (more < std::max(4.0, 0.2 * range)) return {};
  auto difference = sampledBrightness(*photos[indexOf(Pattern::kBlack)], kStep);
  const auto dark = sampledBrightness(*photos[indexOf(darkest)], kStep);
  std::ranges::transform(difference, dark, difference.begin(), std::minus<>());
  if (percentile(difference, 0.3) > 0.3 * more) {
    return {{{Pattern::kBlack},
             "brighter everywhere than the others, by up to " + whole(more) +
                 " codes of 255: room light, or a longer "
                 "exposure",
             "darken the room, fix the exposure by hand, and photograph this projector again"}};
  }
  return {{{Pattern::kBlack, darkest},
           "black shows light where " + patternName(darkest) + " shows none: swapped?",
           "exchange the two, or photograph both again"}};
}

/// Light of one photograph within the frame and beside it.
struct Levels {
  double outside = 0;      // median of photo - black well outside the frame, codes
  double lit = 0;          // camera pixels that are lit within the frame
  double litOutside = 0;   // and well outside
  glm::dvec2 litAt{0, 0};  // where those are
};

class LevelCheck {
 public:
  LevelCheck(const PatternPhotoRefs& photos, const FrameLight& frame) : photos_(photos), frame_(frame) {
    const int reach = 2 * static_cast<int>(0.5 * frame.cell()) + 1;
    const cv::Mat inside(frame.mask.height(), frame.mask.width(), CV_8UC1,
                         const_cast<std::uint8_t*>(frame.mask.samples().data()));
    near_ = Image8(frame.mask.size(), 1);
    cv::Mat nearView(near_.height(), near_.width(), CV_8UC1, near_.samples().data());
    cv::dilate(inside, nearView, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
    for (const Pattern pattern : allPatterns()) levels_[indexOf(pattern)] = measure(*photos_[indexOf(pattern)]);
  }

  std::vector<PhotoProblem> run() {
    checkRoomLight();
    checkOtherProjectors();
    return std::move(problems_);
  }

 private:
  static constexpr int kStep = 5;

  [[nodiscard]] Levels measure(const Image8& photo) const {
    std::vector<double> outside;
    std::vector<double> inside;
    std::vector<glm::dvec2> outsideAt;
    for (int y = 1; y + 1 < photo.height(); y += kStep) {
      for (int x = 1; x + 1 < photo.width(); x += kStep) {
        const bool near = near_.at(x, y) != 0;
        if (near && frame_.mask.at(x, y) == 0) continue;
        (near ? inside : outside).push_back(difference(photo, x, y));
        if (!near) outsideAt.emplace_back(x + 0.5, y + 0.5);
      }
    }
    Levels levels;
    if (outside.size() > 50) {
      auto sorted = outside;
      const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
      std::nth_element(sorted.begin(), middle, sorted.end());
      levels.outside = *middle;
    }
    const double threshold = levels.outside + std::max(6.0, 0.25 * frame_.level);
    for (const double light : inside) levels.lit += light > threshold ? kStep * kStep : 0;
    for (std::size_t i = 0; i < outside.size(); ++i) {
      if (outside[i] < threshold) continue;
      levels.litOutside += kStep * kStep;
      levels.litAt += double(kStep * kStep) * outsideAt[i];
    }
    if (levels.litOutside > 0) levels.litAt /= levels.litOutside;
    return levels;
  }

  /// From black, mean of nine pixels: noise is no light.
  [[nodiscard]] double difference(const Image8& photo, int x, int y) const {
    int sum = 0;
    double black = 0;
    for (int j = y - 1; j <= y + 1; ++j) {
      for (int i = x - 1; i <= x + 1; ++i) {
        sum += photo.at(i, j, 0) + photo.at(i, j, 1) + photo.at(i, j, 2);
        black += frame_.black.at(i, j);
      }
    }
    return (sum / 3.0 - black) / 9;
  }

  /// What a photograph may be brighter beside the frame: white lights the room a little, and codes are only read.
  [[nodiscard]] double mostStray(Pattern pattern) const {
    if (pattern == Pattern::kWhite) return std::max(2.0, 0.12 * frame_.level);
    return pattern == Pattern::kBlobs ? std::max(1.0, 0.02 * frame_.level) : std::max(2.0, 0.05 * frame_.level);
  }

  void checkRoomLight() {
    const auto outside = [&](Pattern pattern) { return levels_[indexOf(pattern)].outside; };
    const auto shifted = [&](Pattern pattern) { return std::abs(outside(pattern)) > mostStray(pattern); };
    const auto patterns = allPatterns();
    if (std::ranges::count_if(patterns, shifted) >= kPatternCount - 3) {
      add({Pattern::kBlack}, besideText(-outside(Pattern::kBlobs), "the others") + ": room light, or another exposure",
          "keep the room dark and the exposure fixed, and photograph this projector again");
      return;
    }
    for (const Pattern pattern : patterns) {
      if (!shifted(pattern)) continue;
      add({pattern}, besideText(outside(pattern), "black") + ": room light was on, or the exposure differs",
          "keep the room dark and the exposure fixed, and photograph it again", pattern < Pattern::kBit0);
    }
  }

  [[nodiscard]] static std::string besideText(double codes, const std::string& other) {
    return "beside the projector's frame it is " + whole(std::abs(codes)) + " codes of 255 " +
           (codes > 0 ? "brighter" : "darker") + " than " + other;
  }

  void checkOtherProjectors() {
    std::vector<Pattern> beside;
    for (const Pattern pattern : allPatterns()) {
      const Levels& levels = levels_[indexOf(pattern)];
      const bool much = levels.litOutside > 0.01 * double(frame_.area) && levels.litOutside > 0.3 * levels.lit;
      if (pattern >= Pattern::kBlobs && much) beside.push_back(pattern);
    }
    if (beside.size() > 4) {
      add({Pattern::kWhite}, "its lit frame is not where the other photographs show light: another projector's white?",
          "photograph white again with only this projector lit");
    } else if (!beside.empty()) {
      add(beside,
          std::string(beside.size() == 1 ? "it shows" : "they show") + " light outside this projector's frame (" +
              placeInPhoto(levels_[indexOf(beside.front())].litAt, photos_[0]->size()) +
              " of the photograph): another projector's picture?",
          "photograph again with only this projector lit");
    }
  }

  void add(std::vector<Pattern> patterns, std::string seen, std::string advice, bool fatal = true) {
    problems_.push_back({std::move(patterns), std::move(seen), std::move(advice), fatal});
  }

  const PatternPhotoRefs& photos_;
  const FrameLight& frame_;
  Image8 near_;  // not zero within the frame and half a cell around it
  std::array<Levels, kPatternCount> levels_{};
  std::vector<PhotoProblem> problems_;
};

/// The photograph after white with the most light.
Pattern fullest(const PatternPhotoRefs& photos) {
  Pattern best = Pattern::kBlobs;
  double most = -1;
  for (const Pattern pattern : allPatterns()) {
    if (pattern <= Pattern::kWhite) continue;
    const auto codes = photos[indexOf(pattern)]->samples();
    const double sum = std::accumulate(codes.begin(), codes.end(), 0.0);
    if (sum <= most) continue;
    most = sum;
    best = pattern;
  }
  return best;
}

}  // namespace

std::vector<PhotoProblem> checkFiles(const PatternPhotoRefs& photos) {
  auto problems = checkSizes(photos);
  if (!problems.empty()) return problems;
  problems = checkSame(photos);
  // Most of them alike is darkness, or one file copied: said when no frame is found.
  if (problems.size() >= kPatternCount / 2) problems.clear();
  std::ranges::move(checkBlack(photos), std::back_inserter(problems));
  return problems;
}

PhotoProblem explainNoFrame(const PatternPhotoRefs& photos) {
  const double white = percentile(sampledBrightness(*photos[indexOf(Pattern::kWhite)], 3), 0.995);
  return {{Pattern::kWhite},
          "no brighter than black (" + whole(white) + " codes of 255 where it is brightest)",
          "is the projector on, uncovered and in the camera's view, and the exposure long enough?"};
}

std::vector<PhotoProblem> checkLight(const PatternPhotoRefs& photos, const FrameLight& frame) {
  std::vector<PhotoProblem> problems;
  if (frame.saturatedShare > kMostSaturated) {
    // Spots may still be found, but where white is clipped their light cannot be divided by it.
    problems.push_back({{Pattern::kWhite},
                        "over-exposed: " + whole(100 * frame.saturatedShare) +
                            " % of the lit area is saturated, mostly " +
                            placeInPhoto(frame.saturatedAt, photos[0]->size()) + " of the photograph",
                        "shorten the exposure of all photographs until white stays below 85 %"});
  }
  if (frame.pieces > 12) {
    problems.push_back({{Pattern::kWhite, fullest(photos)},
                        "white shows " + std::to_string(frame.pieces) + " separate spots of light, not a frame, and " +
                            patternName(fullest(photos)) + " is brighter: swapped?",
                        "exchange the two, or photograph both again"});
    return problems;
  }
  if (percentile({frame.range.samples().begin(), frame.range.samples().end()}, 0.02) >
      std::max(3.0, 0.05 * frame.level)) {
    problems.push_back({{Pattern::kWhite},
                        "brighter than black in every corner: room light was on, or the frame fills the photograph",
                        "keep the room dark, and move the camera back until the whole frame is in the photograph"});
    return problems;
  }
  std::ranges::move(LevelCheck(photos, frame).run(), std::back_inserter(problems));
  return problems;
}

}  // namespace pixelflex::calib
