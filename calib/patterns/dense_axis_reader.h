#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calib/patterns/dense_pattern.h"

namespace pixelflex::calib {

/// How far the waves lie from the middles of the coded cells: spread evenly over half a period about zero, unless the
/// camera moved in between.
class WaveOffsets {
 public:
  /// In periods, -0.5..0.5.
  void add(float offset);
  WaveOffsets& operator+=(const WaveOffsets& other);
  /// The mean on the circle, in periods.
  [[nodiscard]] double mean() const;

 private:
  static constexpr int kBins = 64;
  std::array<std::int64_t, kBins> bins_{};
};

/// One camera pixel in all photographs.
struct PixelCodes {
  const std::vector<const std::uint8_t*>& rows;  // of each photograph, at the pixel's y
  std::size_t offset;                            // of the pixel in them
  /// Three times the mean code of its channels.
  [[nodiscard]] float at(std::size_t photo) const {
    const std::uint8_t* code = rows[photo] + offset;
    return static_cast<float>(code[0] + code[1] + code[2]);
  }
};

/// What a pixel tells: faint when the wave hardly moves there, contradicting when there is no wave or it disagrees with
/// the code.
enum class Reading { kKnown, kFaint, kContradicting };

/// Reads one projector coordinate from single pixels. Thread-bound.
class AxisReader {
 public:
  /// Keeps a reference to the axis. The numbers are those of its first pictures in DenseOrder.
  AxisReader(const DenseAxis& axis, std::size_t firstCode, std::size_t firstWave);

  /// `range`: white above black there. Sets the position, in projector pixels, when it is known.
  [[nodiscard]] Reading read(const PixelCodes& codes, float black, float range, float& position);
  [[nodiscard]] const WaveOffsets& offsets() const { return offsets_; }

 private:
  [[nodiscard]] Reading readWave(const PixelCodes& codes, float range, float& turns) const;
  [[nodiscard]] std::optional<int> readCell(const PixelCodes& codes, float black, float range) const;

  const DenseAxis& axis_;
  std::size_t firstCode_;
  std::size_t firstWave_;
  std::array<float, kPhaseSteps> cosine_{};
  std::array<float, kPhaseSteps> sine_{};
  WaveOffsets offsets_;
};

}  // namespace pixelflex::calib
