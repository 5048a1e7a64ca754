#include "calib/patterns/blob_decoder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/geometry/homography.h"
#include "calib/patterns/blob_fit.h"

namespace pixelflex::calib {
namespace {

constexpr double kSaturatedCode = 250;  // of 255
constexpr double kMostBend = 0.5;     // cells that a wide lens may bend the grid; a misread code is off by one at least
constexpr double kFaintestLight = 4;  // codes between black and white below which nothing can be measured

std::size_t indexOf(Pattern pattern) {
  return static_cast<std::size_t>(pattern);
}

cv::Mat rgbView(const devices::Image8& photo) {
  // OpenCV reads only: the cast drops a const that cv::Mat cannot express.
  return {photo.height(), photo.width(), CV_8UC3, const_cast<std::uint8_t*>(photo.samples().data())};
}

cv::Mat brightness(const devices::Image8& photo) {
  cv::Mat mean;
  cv::transform(rgbView(photo), mean, cv::Matx13f(1 / 3.F, 1 / 3.F, 1 / 3.F));
  cv::Mat result;
  mean.convertTo(result, CV_32F);
  return result;
}

double percentile(const cv::Mat& values, const cv::Mat& mask, double fraction) {
  std::vector<float> sorted;
  for (int y = 0; y < values.rows; ++y) {
    for (int x = 0; x < values.cols; ++x) {
      if (mask.empty() || mask.at<std::uint8_t>(y, x) != 0) sorted.push_back(values.at<float>(y, x));
    }
  }
  if (sorted.empty()) return 0;
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), nth, sorted.end());
  return *nth;
}

/// A spot of light in the camera's picture.
struct Spot {
  glm::dvec2 pointInRaw{0, 0};
  int id = 0;
  double confidence = 0;
};

class Decoder {
 public:
  Decoder(const PatternPhotos& photos, const BlobLayout& layout, const CameraMapping& camera)
      : photos_(photos), layout_(layout), camera_(camera) {}

  DecodedBlobs run() {
    if (!samePhotoSizes()) return failed("the photographs differ in size: take all with one camera and one setting");
    if (!findFrame()) return result_;
    lightOf(Pattern::kBlobs).copyTo(light_);
    std::vector<Spot> spots = findSpots();
    result_.located = static_cast<int>(spots.size());
    readCodes(spots);
    keepConsistent(spots);
    if (spots.size() >= 8) refine(spots);
    explainMissing();
    return result_;
  }

 private:
  DecodedBlobs failed(const std::string& hint) {
    result_.hint = hint;
    return result_;
  }

  [[nodiscard]] bool samePhotoSizes() const {
    return std::ranges::all_of(
        photos_, [this](const auto& photo) { return photo.channels() == 3 && photo.size() == photos_.front().size(); });
  }

  /// The part of the picture that the white frame lights, and black and white there.
  bool findFrame() {
    black_ = brightness(photos_[indexOf(Pattern::kBlack)]);
    white_ = brightness(photos_[indexOf(Pattern::kWhite)]);
    range_ = white_ - black_;
    cv::Mat smooth;
    cv::GaussianBlur(range_, smooth, {5, 5}, 0);
    const double full = percentile(smooth, {}, 0.995);
    if (full < kFaintestLight) {
      result_.hint = darkHint();
      return false;
    }
    cv::Mat labels;
    cv::Mat stats;
    cv::Mat centres;
    const cv::Mat lit = smooth > 0.15 * full;
    const int count = cv::connectedComponentsWithStats(lit, labels, stats, centres, 8);
    int largest = 0;
    for (int i = 1; i < count; ++i) {
      if (largest == 0 || stats.at<int>(i, cv::CC_STAT_AREA) > stats.at<int>(largest, cv::CC_STAT_AREA)) largest = i;
    }
    if (largest == 0) {
      result_.hint = darkHint();
      return false;
    }
    frame_ = labels == largest;
    const cv::Rect box(stats.at<int>(largest, cv::CC_STAT_LEFT), stats.at<int>(largest, cv::CC_STAT_TOP),
                       stats.at<int>(largest, cv::CC_STAT_WIDTH), stats.at<int>(largest, cv::CC_STAT_HEIGHT));
    cutOff_ = box.x <= 1 || box.y <= 1 || box.br().x >= frame_.cols - 1 || box.br().y >= frame_.rows - 1;
    cv::Mat saturated = white_ >= kSaturatedCode;
    saturated &= frame_;
    result_.saturatedShare = double(cv::countNonZero(saturated)) / cv::countNonZero(frame_);
    return true;
  }

  [[nodiscard]] std::string darkHint() const {
    const double blackMean = cv::mean(black_)[0];
    const double whiteMean = cv::mean(white_)[0];
    if (blackMean > whiteMean + 1) {
      return "the photograph of black is brighter than the photograph of white: were they swapped?";
    }
    return "the photograph of white is no brighter than the one of black: is the projector on, uncovered and in the "
           "camera's view, and the exposure long enough?";
  }

  /// Light relative to the projector's own white, 0..1 within its frame, 0 elsewhere.
  [[nodiscard]] cv::Mat lightOf(Pattern pattern) const {
    cv::Mat light = (brightness(photos_[indexOf(pattern)]) - black_) / range_;
    light.setTo(0, ~frame_);
    cv::min(light, 2.0, light);
    cv::max(light, -1.0, light);
    return light;
  }

  std::vector<Spot> findSpots() {
    cv::Mat smooth;
    cv::GaussianBlur(light_, smooth, {3, 3}, 0);
    peak_ = percentile(smooth, frame_, 0.998);
    if (peak_ < 0.1) return {};
    const cv::Mat bright = smooth > 0.45 * peak_;
    cv::Mat labels;
    cv::Mat stats;
    cv::Mat centres;
    const int count = cv::connectedComponentsWithStats(bright, labels, stats, centres, 8);
    std::vector<Spot> spots;
    for (int i = 1; i < count; ++i) {
      if (stats.at<int>(i, cv::CC_STAT_AREA) < 4) continue;
      spots.push_back({{centres.at<double>(i, 0) + 0.5, centres.at<double>(i, 1) + 0.5}});
      if (spots.size() > std::size_t{20} * kBlobCount) return {};  // noise, not blobs
    }
    return spots;
  }

  [[nodiscard]] static double meanAround(const cv::Mat& light, glm::dvec2 pointInRaw) {
    const int x = static_cast<int>(pointInRaw.x);
    const int y = static_cast<int>(pointInRaw.y);
    const cv::Rect window = cv::Rect(x - 1, y - 1, 3, 3) & cv::Rect(0, 0, light.cols, light.rows);
    return cv::mean(light(window))[0];
  }

  /// The seven bits of every spot (least significant first), with how far the least certain is from a coin toss.
  void readCodes(std::vector<Spot>& spots) {
    for (auto& spot : spots) spot.confidence = 1;
    for (int bit = 0; bit < kCodeBits; ++bit) {
      const cv::Mat light = lightOf(static_cast<Pattern>(static_cast<int>(Pattern::kBit0) + bit));
      for (auto& spot : spots) {
        const double ratio = meanAround(light, spot.pointInRaw) / std::max(1e-3, meanAround(light_, spot.pointInRaw));
        if (ratio > 0.5) spot.id |= 1 << bit;
        spot.confidence = std::min(spot.confidence, std::min(1.0, std::abs(ratio - 0.5) * 2));
      }
    }
    std::map<int, Spot> best;
    for (const auto& spot : spots) {
      if (spot.id < 1 || spot.id > kBlobCount || spot.confidence < 0.2) continue;
      auto& kept = best[spot.id];
      if (spot.confidence > kept.confidence) kept = spot;
    }
    spots.clear();
    for (const auto& [id, spot] : best) spots.push_back(spot);
  }

  [[nodiscard]] std::vector<cv::Point2d> pointsInProjector(const std::vector<Spot>& spots) const {
    std::vector<cv::Point2d> points;
    for (const auto& spot : spots) points.emplace_back(layout_.centre(spot.id).x, layout_.centre(spot.id).y);
    return points;
  }
  [[nodiscard]] std::vector<cv::Point2d> pointsInCamera(const std::vector<Spot>& spots) const {
    std::vector<cv::Point2d> points;
    for (const auto& spot : spots) {
      const glm::dvec2 undistorted = camera_.undistortedFromRaw(spot.pointInRaw);
      points.emplace_back(undistorted.x, undistorted.y);
    }
    return points;
  }
  [[nodiscard]] static Homography toHomography(const cv::Mat& h) {
    std::array<double, 9> rowMajor{};
    std::copy_n(h.ptr<double>(), 9, rowMajor.begin());
    return Homography(rowMajor);
  }

  /// A misread code puts a spot a whole cell away from where a homography expects it.
  void keepConsistent(std::vector<Spot>& spots) {
    if (spots.size() < 8) return;
    const double cell = std::sqrt(cv::countNonZero(frame_) / double(kBlobCount));  // camera pixels
    cv::Mat inliers;
    const cv::Mat h = cv::findHomography(pointsInProjector(spots), pointsInCamera(spots), cv::RANSAC, kMostBend * cell,
                                         inliers, 2000, 0.999);
    if (h.empty()) {
      spots.clear();
      return;
    }
    std::vector<Spot> kept;
    for (std::size_t i = 0; i < spots.size(); ++i) {
      if (inliers.at<std::uint8_t>(static_cast<int>(i)) != 0) kept.push_back(spots[i]);
    }
    spots = std::move(kept);
    cameraFromProjector_ = toHomography(h);
  }

  /// Second pass: a Gaussian in projector space, under the first pass's map. Around each blob that map is a homography
  /// of its own, which follows the bend of a wide lens where one for the whole frame cannot.
  void refine(const std::vector<Spot>& spots) {
    for (const auto& spot : spots) {
      const Homography cameraFromProjector = mapAround(spot, spots);
      const Homography projectorFromCamera = cameraFromProjector.inverse();
      const glm::dvec2 start = projectorFromCamera.map(camera_.undistortedFromRaw(spot.pointInRaw));
      const auto samples = samplesAround(spot, start, cameraFromProjector);
      const auto fit = fitGaussian(samples, {start, layout_.sigma(), peak_, 0});
      if (!fit || !plausible(*fit, start)) continue;
      result_.blobs.push_back({spot.id, cameraFromProjector.map(fit->centre), spot.confidence});
    }
    const glm::dvec2 middle = layout_.centre(kBlobCount / 2 + kBlobColumns / 2);
    const glm::dvec2 step = cameraFromProjector_.map(middle + glm::dvec2(1, 0)) - cameraFromProjector_.map(middle);
    result_.cameraScale = std::hypot(step.x, step.y);
  }

  /// Least squares through the spots nearest to one of them.
  [[nodiscard]] Homography mapAround(const Spot& spot, std::vector<Spot> spots) const {
    constexpr std::size_t kNeighbours = 16;
    const glm::dvec2 centre = layout_.centre(spot.id);
    const auto distance = [&](const Spot& other) {
      const glm::dvec2 apart = layout_.centre(other.id) - centre;
      return apart.x * apart.x + apart.y * apart.y;
    };
    std::ranges::sort(spots, {}, distance);
    spots.resize(std::min(spots.size(), kNeighbours));
    const cv::Mat h = cv::findHomography(pointsInProjector(spots), pointsInCamera(spots));
    return h.empty() ? cameraFromProjector_ : toHomography(h);
  }

  [[nodiscard]] bool plausible(const GaussianFit& fit, glm::dvec2 start) const {
    const glm::dvec2 shift = fit.centre - start;
    const double sigma = layout_.sigma();
    return std::hypot(shift.x, shift.y) < sigma && fit.sigma > 0.5 * sigma && fit.sigma < 2.5 * sigma &&
           fit.amplitude > 0.3 * peak_;
  }

  [[nodiscard]] std::vector<LightSample> samplesAround(const Spot& spot, glm::dvec2 start,
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
    std::vector<LightSample> samples;
    const auto& photo = photos_[indexOf(Pattern::kBlobs)];
    for (int y = std::max(0, int(low.y)); y < std::min(light_.rows, int(high.y) + 1); ++y) {
      for (int x = std::max(0, int(low.x)); x < std::min(light_.cols, int(high.x) + 1); ++x) {
        if (frame_.at<std::uint8_t>(y, x) == 0 || saturated(photo, x, y)) continue;
        const glm::dvec2 p = projectorFromCamera.map(camera_.undistortedFromRaw({x + 0.5, y + 0.5}));
        if (std::hypot(p.x - start.x, p.y - start.y) <= reach) samples.push_back({p, light_.at<float>(y, x)});
      }
    }
    return samples;
  }

  [[nodiscard]] static bool saturated(const devices::Image8& photo, int x, int y) {
    return photo.at(x, y, 0) >= kSaturatedCode || photo.at(x, y, 1) >= kSaturatedCode ||
           photo.at(x, y, 2) >= kSaturatedCode;
  }

  void explainMissing() {
    std::ranges::sort(result_.blobs, {}, &DecodedBlob::id);
    if (result_.blobs.size() == static_cast<std::size_t>(kBlobCount)) return;
    const double cameraSigma =
        layout_.sigma() * std::sqrt(cv::countNonZero(frame_) / static_cast<double>(layout_.resolution().area()));
    if (result_.saturatedShare > 0.05) {
      result_.hint = "the photograph of white is over-exposed: shorten the exposure until white stays below 85 %";
    } else if (cutOff_) {
      result_.hint = "part of the projector's frame lies outside the photograph: move the camera back or turn it";
    } else if (cameraSigma < 1.2) {
      result_.hint = "the blobs are too small in the photograph: move the camera closer or use one with more pixels";
    } else if (result_.located < kBlobCount / 2) {
      result_.hint = "few blobs are visible: is the picture in focus, and is nothing standing before the wall?";
    } else if (static_cast<int>(result_.blobs.size()) < kBlobCount * 9 / 10 && result_.located >= kBlobCount * 9 / 10) {
      result_.hint =
          "the code photographs contradict each other: was one taken of another pattern, or the camera moved?";
    } else {
      result_.hint = "some blobs are hidden or unsharp";
    }
  }

  const PatternPhotos& photos_;
  const BlobLayout& layout_;
  const CameraMapping& camera_;
  DecodedBlobs result_;
  cv::Mat black_;
  cv::Mat white_;
  cv::Mat range_;  // white - black
  cv::Mat frame_;  // mask of the projector's lit frame
  cv::Mat light_;  // of the photograph of all blobs
  double peak_ = 0;
  bool cutOff_ = false;
  Homography cameraFromProjector_;  // undistorted camera
};

}  // namespace

DecodedBlobs decodeBlobs(const PatternPhotos& photos, const BlobLayout& layout, const CameraMapping& camera) {
  return Decoder(photos, layout, camera).run();
}

}  // namespace pixelflex::calib
