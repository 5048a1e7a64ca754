#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace pixelflex::calib {

/// The rows of the light table.
enum class Figure : std::size_t {
  kStep16,
  kStep32,
  kStep64,
  kStep128,
  kStep200,
  kStep255,
  kUnevenness,
  kGradient,
  kBlack,
  kBlackStep,
  kGrey,
  kPrimaries,
  kInset,
  kInsetDark,
  kSlipped,
  kResponse,
  kTextFine,
  kText,
  kTextSoft,
  kBanding16,
  kBanding64,
  kWhite,
  kContrast,
};
inline constexpr std::size_t kFigureCount = 23;

/// The columns: as PixelFlex shows it, without any correction of light, and by the report's method.
enum class Correction : std::size_t { kMatched, kNone, kReport };
inline constexpr std::size_t kCorrectionCount = 3;

/// What was measured of many walls.
class LightFigures {
 public:
  /// `where`: rig and seed, and the place if it is a place.
  void add(Figure figure, Correction correction, double value, std::string where);

  /// One of the figures in words.
  [[nodiscard]] static std::string told(Figure figure, Correction correction, double value);

  /// A Markdown table. For ours median and worst, for the others the median.
  [[nodiscard]] std::string table() const;
  /// Whether every figure of ours that was measured meets its target.
  [[nodiscard]] bool met() const;
  [[nodiscard]] bool met(Figure figure) const;
  /// The worst of a column; 0 where there is none.
  [[nodiscard]] double worst(Figure figure, Correction correction) const;

 private:
  struct Value {
    double value = 0;
    std::string where;
  };
  using Values = std::vector<Value>;
  [[nodiscard]] const Values& of(Figure figure, Correction correction) const;
  [[nodiscard]] std::string row(Figure figure) const;

  std::array<std::array<Values, kCorrectionCount>, kFigureCount> values_;
};

}  // namespace pixelflex::calib
