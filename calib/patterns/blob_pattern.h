#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "calib/patterns/projected_pattern.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The report's structured light (5.1.3): ten by ten Gaussian blobs, numbered 1 to 100 row by row.
inline constexpr int kBlobColumns = 10;
inline constexpr int kBlobRows = 10;
inline constexpr int kBlobCount = kBlobColumns * kBlobRows;
inline constexpr int kCodeBits = 7;

/// How wide blobs are. Small ones need a camera that sees them over two of its pixels or more; then they are less
/// bent by perspective and the outer ones stand closer to the border. Large ones help a coarse camera.
enum class BlobSize { kUsual, kFine, kCoarse };

/// What suits a camera that sees a projector's pixel this large (camera pixels).
[[nodiscard]] BlobSize blobSizeFor(devices::Size resolution, double cameraScale);

/// Where the blobs stand on a frame and how wide they are. The outer ones stand close to the border, since the smooth
/// model must hold to the last pixel (calibration reference 2, "Frame edge").
class BlobLayout {
 public:
  explicit BlobLayout(devices::Size resolution, BlobSize size = BlobSize::kUsual);
  [[nodiscard]] BlobSize size() const { return size_; }
  [[nodiscard]] devices::Size resolution() const { return resolution_; }
  [[nodiscard]] glm::dvec2 centre(int id) const;         // id 1..100
  [[nodiscard]] double sigma() const { return sigma_; }  // of the light, projector pixels

 private:
  devices::Size resolution_;
  BlobSize size_;
  double sigma_;
  double margin_;
};

/// The pictures of one projector, in the order they are shown.
enum class Pattern { kBlack, kWhite, kBlobs, kBit0, kBit1, kBit2, kBit3, kBit4, kBit5, kBit6 };
inline constexpr int kPatternCount = 3 + kCodeBits;

[[nodiscard]] std::vector<Pattern> allPatterns();
/// "black", "white", "blobs", "bit0" … "bit6": file names without their ending.
[[nodiscard]] std::string patternName(Pattern pattern);
/// What a person sees in it, for instructions and errors.
[[nodiscard]] std::string patternDescription(Pattern pattern);

/// One channel of device codes. Blobs are drawn so that the *light* of a projector with gamma 2.2 is Gaussian (any
/// other power law only changes their width) and peak at 90 % so that nothing saturates.
[[nodiscard]] devices::Image8 renderPattern(Pattern pattern, const BlobLayout& layout);

/// Pictures of blobs that are not of the usual size are called so: "bit3-fine".
[[nodiscard]] ProjectedPattern projected(Pattern pattern, const BlobLayout& layout);

}  // namespace pixelflex::calib
