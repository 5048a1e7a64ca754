#include "calib/patterns/dense_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <thread>

#include "calib/patterns/dense_axis_reader.h"

namespace pixelflex::calib {
namespace {

constexpr std::uint8_t kSaturatedCode = 250;
constexpr double kLitShare = 0.15;  // of the brightest: pixels with more belong to the frame
constexpr float kReach = 2.5F;      // camera pixels from the frame's border that see the dark beyond it

/// Reads rows of pixels; one per thread.
class RowReader {
 public:
  RowReader(const std::vector<devices::Image8>& photos, const DenseLayout& layout, const FrameLight& light)
      : photos_(photos),
        order_(layout),
        x_(layout.x(), order_.columnCode, order_.xWave),
        y_(layout.y(), order_.rowCode, order_.yWave),
        leastRange_(static_cast<float>(3 * kLitShare * light.full)) {}

  void readRow(int y, DensePixels& pixels) {
    rows_.clear();
    for (const auto& photo : photos_) rows_.push_back(photo.row(y).data());
    for (int x = 0; x < pixels.points.width(); ++x) readPixel(x, y, pixels.points);
  }
  [[nodiscard]] const WaveOffsets& xOffsets() const { return x_.offsets(); }
  [[nodiscard]] const WaveOffsets& yOffsets() const { return y_.offsets(); }
  void addCountsTo(DensePixels& pixels) const {
    pixels.lit += lit_;
    pixels.saturated += saturated_;
    pixels.faint += faint_;
    pixels.contradicting += contradicting_;
    pixels.cutOff = pixels.cutOff || onBorder_ > kMostOnBorder;
  }

 private:
  static constexpr int kMostOnBorder = 8;  // pixels: a stray reflection is no frame

  void readPixel(int x, int y, devices::ImageF& points) {
    const PixelCodes codes{rows_, 3 * static_cast<std::size_t>(x)};
    const float black = codes.at(DenseOrder::kBlack);
    const float range = codes.at(DenseOrder::kWhite) - black;
    if (range < leastRange_) return;
    ++lit_;
    if (x == 0 || y == 0 || x == points.width() - 1 || y == points.height() - 1) ++onBorder_;
    const std::uint8_t* white = rows_[DenseOrder::kWhite] + codes.offset;
    if (std::max({white[0], white[1], white[2]}) >= kSaturatedCode) {
      ++saturated_;
      return;
    }
    float column = 0;
    float row = 0;
    Reading reading = x_.read(codes, black, range, column);
    if (reading == Reading::kKnown) reading = y_.read(codes, black, range, row);
    if (reading == Reading::kFaint) ++faint_;
    if (reading == Reading::kContradicting) ++contradicting_;
    if (reading != Reading::kKnown) return;
    points.at(x, y, 0) = column;
    points.at(x, y, 1) = row;
  }

  const std::vector<devices::Image8>& photos_;
  DenseOrder order_;
  AxisReader x_;
  AxisReader y_;
  float leastRange_;
  std::vector<const std::uint8_t*> rows_;
  std::int64_t lit_ = 0, saturated_ = 0, faint_ = 0, contradicting_ = 0;
  int onBorder_ = 0;
};

glm::vec2 pointAt(const devices::ImageF& points, int x, int y) {
  return {points.at(x, y, 0), points.at(x, y, 1)};
}

bool nearBorder(float at, float gradient, int length) {
  const float reach = kReach * gradient + 0.5F;
  return at < reach || at > static_cast<float>(length) - reach;
}

}  // namespace

FrameLight measureFrameLight(const devices::Image8& black, const devices::Image8& white) {
  constexpr double kBrightest = 0.995;
  std::array<std::int64_t, 3 * 255 + 1> histogram{};
  std::int64_t blackSum = 0, whiteSum = 0;
  for (std::size_t i = 0; i + 2 < black.samples().size(); i += 3) {
    const int dark = black.samples()[i] + black.samples()[i + 1] + black.samples()[i + 2];
    const int light = white.samples()[i] + white.samples()[i + 1] + white.samples()[i + 2];
    blackSum += dark;
    whiteSum += light;
    ++histogram.at(static_cast<std::size_t>(std::max(0, light - dark)));
  }
  const auto pixels = static_cast<double>(black.size().area());
  FrameLight result{0, static_cast<double>(blackSum) / (3 * pixels), static_cast<double>(whiteSum) / (3 * pixels)};
  double below = 0;
  for (std::size_t i = 0; i < histogram.size() && below <= kBrightest * pixels; ++i) {
    below += static_cast<double>(histogram[i]);
    result.full = static_cast<double>(i) / 3;
  }
  return result;
}

DensePixels readPixels(const std::vector<devices::Image8>& photos, const DenseLayout& layout, const FrameLight& light) {
  DensePixels pixels;
  pixels.points = devices::ImageF(photos.front().size(), 2);
  std::ranges::fill(pixels.points.samples(), std::numeric_limits<float>::quiet_NaN());
  RowReader upper(photos, layout, light);
  RowReader lower(photos, layout, light);
  const int height = pixels.points.height();
  {
    const std::jthread second([&] {
      for (int y = height / 2; y < height; ++y) lower.readRow(y, pixels);
    });
    for (int y = 0; y < height / 2; ++y) upper.readRow(y, pixels);
  }
  upper.addCountsTo(pixels);
  lower.addCountsTo(pixels);
  pixels.shift = {layout.x().period() * (WaveOffsets(upper.xOffsets()) += lower.xOffsets()).mean(),
                  layout.y().period() * (WaveOffsets(upper.yOffsets()) += lower.yOffsets()).mean()};
  return pixels;
}

void keepContinuous(DensePixels& pixels, const DenseLayout& layout) {
  const devices::ImageF all = pixels.points;
  const float mostBend = 0.15F * static_cast<float>(layout.x().period());
  const auto keeps = [&](int x, int y) {
    if (x == 0 || y == 0 || x == all.width() - 1 || y == all.height() - 1) return false;
    const glm::vec2 here = pointAt(all, x, y);
    const glm::vec2 left = pointAt(all, x - 1, y), right = pointAt(all, x + 1, y);
    const glm::vec2 up = pointAt(all, x, y - 1), down = pointAt(all, x, y + 1);
    // Comparisons with an unknown (NaN) neighbour are false.
    if (!(glm::length(left + right - 2.0F * here) < mostBend && glm::length(up + down - 2.0F * here) < mostBend)) {
      return false;
    }
    const glm::vec2 byX = 0.5F * (right - left);
    const glm::vec2 byY = 0.5F * (down - up);
    return !nearBorder(here.x, std::hypot(byX.x, byY.x), layout.x().length()) &&
           !nearBorder(here.y, std::hypot(byX.y, byY.y), layout.y().length());
  };
  for (int y = 0; y < all.height(); ++y) {
    for (int x = 0; x < all.width(); ++x) {
      if (!keeps(x, y)) pixels.points.at(x, y, 0) = pixels.points.at(x, y, 1) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

double cameraScaleOf(const DensePixels& pixels) {
  constexpr int kStride = 5;
  std::vector<double> areas;  // projector pixels per camera pixel
  for (int y = 0; y + 1 < pixels.points.height(); y += kStride) {
    for (int x = 0; x + 1 < pixels.points.width(); x += kStride) {
      const glm::dvec2 here = pointAt(pixels.points, x, y);
      const glm::dvec2 byX = glm::dvec2(pointAt(pixels.points, x + 1, y)) - here;
      const glm::dvec2 byY = glm::dvec2(pointAt(pixels.points, x, y + 1)) - here;
      const double area = std::abs(byX.x * byY.y - byX.y * byY.x);
      if (area > 0) areas.push_back(area);
    }
  }
  if (areas.empty()) return 0;
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return 1 / std::sqrt(*middle);
}

}  // namespace pixelflex::calib
