#include "calib/patterns/blob_light.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

constexpr double kFaintestLight = 4;  // codes between black and white below which nothing can be measured

/// OpenCV reads only: the cast drops a const that cv::Mat cannot express.
cv::Mat view(const ImageF& image) {
  return {image.height(), image.width(), CV_32FC1, const_cast<float*>(image.samples().data())};
}

/// Marks what is lit. A person may cut a frame in two; a speck is not part of it.
void markPieces(const cv::Mat& lit, FrameLight& frame) {
  constexpr double kSpeck = 0.05;  // of the largest piece
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(lit, labels, stats, centres, 8);
  const auto stat = [&](int i, int which) { return stats.at<int>(i, which); };
  int largest = 0;
  cv::Rect box;
  for (int i = 1; i < count; ++i) largest = std::max(largest, stat(i, cv::CC_STAT_AREA));
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(count));
  for (int i = 1; i < count; ++i) {
    if (stat(i, cv::CC_STAT_AREA) < kSpeck * largest) continue;
    kept[static_cast<std::size_t>(i)] = 255;
    ++frame.pieces;
    frame.area += stat(i, cv::CC_STAT_AREA);
    const cv::Rect piece(stat(i, cv::CC_STAT_LEFT), stat(i, cv::CC_STAT_TOP), stat(i, cv::CC_STAT_WIDTH),
                         stat(i, cv::CC_STAT_HEIGHT));
    box |= piece;
  }
  frame.left = box.x;
  frame.top = box.y;
  frame.right = box.br().x;
  frame.bottom = box.br().y;
  frame.cutOff = box.x <= 1 || box.y <= 1 || frame.right >= lit.cols - 1 || frame.bottom >= lit.rows - 1;
  frame.mask = Image8({lit.cols, lit.rows}, 1);
  for (int y = 0; y < lit.rows; ++y) {
    for (int x = 0; x < lit.cols; ++x) frame.mask.at(x, y) = kept[static_cast<std::size_t>(labels.at<int>(y, x))];
  }
}

void measureSaturation(const Image8& white, FrameLight& frame) {
  std::int64_t saturated = 0;
  glm::dvec2 sum{0, 0};
  for (int y = 0; y < white.height(); ++y) {
    const auto inside = frame.mask.row(y);
    const auto codes = white.row(y);
    for (std::size_t x = 0; x < inside.size(); ++x) {
      // The mean of the channels: one clipped channel alone costs little.
      if (inside[x] == 0 || codes[3 * x] + codes[3 * x + 1] + codes[3 * x + 2] < 3 * kSaturatedCode) continue;
      ++saturated;
      sum += glm::dvec2(static_cast<double>(x) + 0.5, y + 0.5);
    }
  }
  frame.saturatedShare = double(saturated) / double(frame.area);
  if (saturated > 0) frame.saturatedAt = sum / double(saturated);
}

std::vector<float> withinFrame(const ImageF& image, const FrameLight& frame) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(frame.area));
  for (int y = frame.top; y < frame.bottom; ++y) {
    for (int x = frame.left; x < frame.right; ++x) {
      if (frame.mask.at(x, y) != 0) values.push_back(image.at(x, y));
    }
  }
  return values;
}

/// OpenCV's view of the frame's box.
cv::Mat boxView(const ImageF& image, const FrameLight& frame) {
  return view(image)(cv::Range(frame.top, frame.bottom), cv::Range(frame.left, frame.right));
}

}  // namespace

double FrameLight::cell() const {
  return std::sqrt(static_cast<double>(area) / kBlobCount);
}

ImageF brightness(const Image8& photo) {
  ImageF mean(photo.size(), 1);
  const auto codes = photo.samples();
  const auto out = mean.samples();
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<float>(codes[3 * i] + codes[3 * i + 1] + codes[3 * i + 2]) * (1 / 3.0F);
  }
  return mean;
}

double percentile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::vector<float> sampledBrightness(const Image8& photo, int step) {
  std::vector<float> values;
  for (int y = 0; y < photo.height(); y += step) {
    for (int x = 0; x < photo.width(); x += step) {
      values.push_back(static_cast<float>(photo.at(x, y, 0) + photo.at(x, y, 1) + photo.at(x, y, 2)) * (1 / 3.0F));
    }
  }
  return values;
}

std::optional<FrameLight> findFrame(const PatternPhotoRefs& photos) {
  FrameLight frame;
  frame.black = brightness(*photos[indexOf(Pattern::kBlack)]);
  frame.range = brightness(*photos[indexOf(Pattern::kWhite)]);
  const auto black = frame.black.samples();
  const auto range = frame.range.samples();
  for (std::size_t i = 0; i < range.size(); ++i) range[i] -= black[i];
  ImageF smooth(frame.range.size(), 1);
  cv::Mat smoothView = view(smooth);
  cv::GaussianBlur(view(frame.range), smoothView, {5, 5}, 0);
  const double full = percentile({smooth.samples().begin(), smooth.samples().end()}, 0.995);
  if (full < kFaintestLight) return std::nullopt;
  markPieces(smoothView > 0.15 * full, frame);
  if (frame.pieces == 0) return std::nullopt;
  frame.level = percentile(withinFrame(frame.range, frame), 0.5);
  measureSaturation(*photos[indexOf(Pattern::kWhite)], frame);
  return frame;
}

double cameraScaleOf(const Image8& black, const Image8& white, devices::Size resolution) {
  PatternPhotoRefs photos{};
  photos.fill(&white);
  photos[indexOf(Pattern::kBlack)] = &black;
  const auto frame = findFrame(photos);
  return frame ? std::sqrt(static_cast<double>(frame->area) / static_cast<double>(resolution.area())) : 0;
}

Image8 withoutRim(const FrameLight& frame, double rim) {
  const Image8& mask = frame.mask;
  const cv::Mat inside(mask.height(), mask.width(), CV_8UC1, const_cast<std::uint8_t*>(mask.samples().data()));
  cv::Mat distance;
  cv::distanceTransform(inside, distance, cv::DIST_L2, cv::DIST_MASK_3);
  Image8 result(mask.size(), 1);
  cv::Mat(distance > rim).copyTo(cv::Mat(mask.height(), mask.width(), CV_8UC1, result.samples().data()));
  return result;
}

ImageF relativeLight(const Image8& photo, const FrameLight& frame) {
  ImageF light(photo.size(), 1);
  for (int y = frame.top; y < frame.bottom; ++y) {
    const auto codes = photo.row(y);
    const auto mask = frame.mask.row(y);
    const auto black = frame.black.row(y);
    const auto range = frame.range.row(y);
    const auto out = light.row(y);
    for (auto x = static_cast<std::size_t>(frame.left); x < static_cast<std::size_t>(frame.right); ++x) {
      if (mask[x] == 0 || range[x] <= 0) continue;
      const float mean = static_cast<float>(codes[3 * x] + codes[3 * x + 1] + codes[3 * x + 2]) * (1 / 3.0F);
      out[x] = std::clamp((mean - black[x]) / range[x], -1.0F, 2.0F);
    }
  }
  return light;
}

Spots findSpots(const ImageF& light, const FrameLight& frame) {
  Spots spots;
  ImageF smooth(light.size(), 1);
  cv::Mat smoothView = boxView(smooth, frame);
  cv::GaussianBlur(boxView(light, frame), smoothView, {3, 3}, 0);
  spots.peak = percentile(withinFrame(smooth, frame), 0.998);
  if (spots.peak < 0.1) return spots;
  const double threshold = 0.45 * spots.peak;
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(smoothView > threshold, labels, stats, centres, 8);
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < 4) continue;
    const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    glm::dvec2 sum{0, 0};
    double weight = 0;
    for (int y = box.y; y < box.br().y; ++y) {
      for (int x = box.x; x < box.br().x; ++x) {
        if (labels.at<int>(y, x) != i) continue;
        const double above = smoothView.at<float>(y, x) - threshold;
        sum += above * glm::dvec2(frame.left + x + 0.5, frame.top + y + 0.5);
        weight += above;
      }
    }
    spots.pointsInRaw.push_back(sum / weight);
    if (spots.pointsInRaw.size() > std::size_t{20} * kBlobCount) return {{}, spots.peak};
  }
  return spots;
}

double meanAround(const ImageF& light, glm::dvec2 pointInRaw, int reach) {
  const int x0 = std::max(0, static_cast<int>(pointInRaw.x) - reach);
  const int y0 = std::max(0, static_cast<int>(pointInRaw.y) - reach);
  const int x1 = std::min(light.width() - 1, static_cast<int>(pointInRaw.x) + reach);
  const int y1 = std::min(light.height() - 1, static_cast<int>(pointInRaw.y) + reach);
  double sum = 0;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) sum += light.at(x, y);
  }
  const int count = std::max(0, x1 - x0 + 1) * std::max(0, y1 - y0 + 1);
  return count > 0 ? sum / count : 0;
}

std::string placeInPhoto(glm::dvec2 pointInRaw, devices::Size photo) {
  const auto third = [](double at, int length) { return std::size_t(std::clamp(3 * at / length, 0.0, 2.9)); };
  const std::array<const char*, 9> names = {"upper left", "upper middle", "upper right",  "left",       "middle",
                                            "right",      "lower left",   "lower middle", "lower right"};
  return names[3 * third(pointInRaw.y, photo.height) + third(pointInRaw.x, photo.width)];
}

}  // namespace pixelflex::calib
