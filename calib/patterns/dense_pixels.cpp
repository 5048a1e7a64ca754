#include "calib/patterns/dense_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>

namespace pixelflex::calib {
namespace {

constexpr std::uint8_t kSaturatedCode = 250;
constexpr double kLitShare = 0.15;   // of the brightest: pixels with more belong to the frame
constexpr float kLeastWave = 0.08F;  // amplitude over white; sharp it is 0.42
constexpr float kLeastWaveCodes = 0.8F;
constexpr float kMostRest = 0.08F;         // what is no wave, RMS over white
constexpr float kRestCodes = 1.5F;         // likewise, from noise
constexpr float kTossUp = 0.15F;           // a bit so close to one half may be either
constexpr float kMostDisagreement = 0.4F;  // of the period, between wave and the middle of the coded cell
constexpr float kReach = 2.5F;             // camera pixels from the frame's border that see the dark beyond it

/// How far the waves lie from the middles of the coded cells: spread evenly over half a period about zero, unless the
/// camera moved in between.
class Offsets {
 public:
  /// In periods, -0.5..0.5.
  void add(float offset) {
    const int bin = static_cast<int>(std::floor((offset + 0.5F) * kBins));
    ++bins_.at(static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1)));
  }
  Offsets& operator+=(const Offsets& other) {
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
    return *this;
  }
  /// The mean on the circle, in periods.
  [[nodiscard]] double mean() const {
    double byCosine = 0, bySine = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      const double angle = 2 * std::numbers::pi * ((static_cast<double>(i) + 0.5) / kBins - 0.5);
      byCosine += static_cast<double>(bins_[i]) * std::cos(angle);
      bySine += static_cast<double>(bins_[i]) * std::sin(angle);
    }
    return std::atan2(bySine, byCosine) / (2 * std::numbers::pi);
  }

 private:
  static constexpr int kBins = 64;
  std::array<std::int64_t, kBins> bins_{};
};

enum class Reading { kKnown, kFaint, kContradicting };

/// Sums over the three channels of the photographs' pixels: codes times three.
struct PixelCodes {
  const std::vector<const std::uint8_t*>& rows;
  std::size_t offset;
  [[nodiscard]] float at(std::size_t photo) const {
    const std::uint8_t* code = rows[photo] + offset;
    return static_cast<float>(code[0] + code[1] + code[2]);
  }
};

/// One coordinate from one pixel's codes.
class AxisReader {
 public:
  AxisReader(const DenseAxis& axis, std::size_t firstCode, std::size_t firstWave)
      : axis_(axis), firstCode_(firstCode), firstWave_(firstWave) {
    for (std::size_t i = 0; i < kPhaseSteps; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kPhaseSteps;
      cosine_.at(i) = static_cast<float>(std::cos(angle));
      sine_.at(i) = static_cast<float>(std::sin(angle));
    }
  }

  [[nodiscard]] Reading read(const PixelCodes& codes, float black, float range, float& position) {
    float turns = 0;
    const Reading wave = readWave(codes, range, turns);
    if (wave != Reading::kKnown) return wave;
    const std::optional<int> cell = readCell(codes, black, range);
    if (!cell) return Reading::kContradicting;
    const auto period = static_cast<float>(axis_.period());
    const float middle = (static_cast<float>(*cell) + 0.5F) / 2;  // in periods
    const float offset = turns - middle - std::round(turns - middle);
    offsets_.add(offset);
    position = period * (middle + offset);
    const bool inFrame = position > -period && position < static_cast<float>(axis_.length()) + period;
    return inFrame && std::abs(offset) <= kMostDisagreement ? Reading::kKnown : Reading::kContradicting;
  }
  [[nodiscard]] const Offsets& offsets() const { return offsets_; }

 private:
  [[nodiscard]] Reading readWave(const PixelCodes& codes, float range, float& turns) const {
    float mean = 0, square = 0, byCosine = 0, bySine = 0;
    for (std::size_t i = 0; i < kPhaseSteps; ++i) {
      const float code = codes.at(firstWave_ + i);
      mean += code / kPhaseSteps;
      square += code * code / kPhaseSteps;
      byCosine += code * cosine_[i] * 2 / kPhaseSteps;
      bySine += code * sine_[i] * 2 / kPhaseSteps;
    }
    const float power = byCosine * byCosine + bySine * bySine;
    const float least = std::max(kLeastWave * range, 3 * kLeastWaveCodes);
    if (power < least * least) return Reading::kFaint;
    const float rest = square - mean * mean - power / 2;
    const float mostRest = kMostRest * range + 3 * kRestCodes;
    if (rest > mostRest * mostRest) return Reading::kContradicting;
    turns = std::atan2(bySine, byCosine) / (2 * std::numbers::pi_v<float>);
    return Reading::kKnown;
  }

  /// Along a Gray code at most one bit is undecided, and the wave decides between the two cells.
  [[nodiscard]] std::optional<int> readCell(const PixelCodes& codes, float black, float range) const {
    int binary = 0;
    int undecided = 0;
    for (int bit = 0; bit < axis_.bits(); ++bit) {
      const float light = (codes.at(firstCode_ + static_cast<std::size_t>(bit)) - black) / range;
      if (std::abs(light - 0.5F) < kTossUp) ++undecided;
      const int gray = light > 0.5F ? 1 : 0;
      binary = 2 * binary + (gray ^ (binary & 1));
    }
    return undecided > 1 ? std::nullopt : std::optional(binary);
  }

  const DenseAxis& axis_;
  std::size_t firstCode_;
  std::size_t firstWave_;
  std::array<float, kPhaseSteps> cosine_{};
  std::array<float, kPhaseSteps> sine_{};
  Offsets offsets_;
};

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
  [[nodiscard]] const Offsets& xOffsets() const { return x_.offsets(); }
  [[nodiscard]] const Offsets& yOffsets() const { return y_.offsets(); }
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
  pixels.shift = {layout.x().period() * (Offsets(upper.xOffsets()) += lower.xOffsets()).mean(),
                  layout.y().period() * (Offsets(upper.yOffsets()) += lower.yOffsets()).mean()};
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
