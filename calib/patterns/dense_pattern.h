#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "calib/patterns/projected_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

inline constexpr int kPhaseSteps = 8;

/// The stripes that measure one coordinate of a frame: waves of light, shifted step by step, tell the place within a
/// period; a Gray code tells the period. The code counts half periods, so that a misread bit at the border of two of
/// them still leaves no doubt about the period (calibration reference 1.3, 1.4).
class DenseAxis {
 public:
  /// `length` in projector pixels; `period` even.
  DenseAxis(int length, int period);
  [[nodiscard]] int length() const { return length_; }
  [[nodiscard]] int period() const { return period_; }
  [[nodiscard]] double cell() const { return 0.5 * period_; }
  [[nodiscard]] int bits() const { return bits_; }
  /// Code of a pixel, 0 or 255; bit 0 is the coarsest.
  [[nodiscard]] std::uint8_t grayCode(int pixel, int bit) const;
  /// Code of a pixel in one of the steps: drawn so that the *light* of a projector with gamma 2.2 is a wave whose crest
  /// stands at step/8 of the period, between a floor above any toe and 90 %.
  [[nodiscard]] std::uint8_t waveCode(int pixel, int step) const;

 private:
  int length_;
  int period_;
  int bits_ = 0;
};

/// The axes of a frame and the lattice of projector points that are measured.
class DenseLayout {
 public:
  explicit DenseLayout(devices::Size resolution);
  [[nodiscard]] const DenseAxis& x() const { return x_; }
  [[nodiscard]] const DenseAxis& y() const { return y_; }

  /// 48 points along the longer side, as dense along the other; the outer ones a quarter of a step from the border.
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] glm::dvec2 point(int column, int row) const { return margin_ + step_ * glm::dvec2(column, row); }
  [[nodiscard]] glm::dvec2 step() const { return step_; }
  [[nodiscard]] glm::dvec2 margin() const { return margin_; }

 private:
  DenseAxis x_;
  DenseAxis y_;
  int columns_;
  int rows_;
  glm::dvec2 step_;
  glm::dvec2 margin_;
};

/// Black, white, then for columns and for rows the code from coarse to fine, then the eight steps of the wave across
/// (x) and down (y): 2 + x.bits() + y.bits() + 16 pictures. Names are file names without their ending.
[[nodiscard]] std::vector<ProjectedPattern> densePatterns(devices::Size resolution);

/// Place of the first picture of a kind in that order.
struct DenseOrder {
  explicit DenseOrder(const DenseLayout& layout);
  static constexpr std::size_t kBlack = 0;
  static constexpr std::size_t kWhite = 1;
  std::size_t columnCode = 2;
  std::size_t rowCode;
  std::size_t xWave;
  std::size_t yWave;
  std::size_t count;
};

}  // namespace pixelflex::calib
