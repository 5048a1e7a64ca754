#include "calib/patterns/blob_pattern.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace pixelflex::calib {
namespace {

constexpr double kNominalGamma = 2.2;
constexpr double kPeakCode = 0.9 * 255;

bool shows(Pattern pattern, int id) {
  if (pattern == Pattern::kBlobs) return true;
  const int bit = static_cast<int>(pattern) - static_cast<int>(Pattern::kBit0);
  return ((id >> bit) & 1) != 0;
}

void drawBlob(devices::Image8& image, glm::dvec2 centre, double lightSigma) {
  const double sigma = lightSigma * std::sqrt(kNominalGamma);
  const double reach = 4 * sigma;
  const int left = std::max(0, static_cast<int>(centre.x - reach));
  const int right = std::min(image.width(), static_cast<int>(centre.x + reach) + 1);
  const int top = std::max(0, static_cast<int>(centre.y - reach));
  const int bottom = std::min(image.height(), static_cast<int>(centre.y + reach) + 1);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const double dx = x + 0.5 - centre.x;
      const double dy = y + 0.5 - centre.y;
      const double code = kPeakCode * std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      image.at(x, y) = std::max(image.at(x, y), static_cast<std::uint8_t>(std::lround(code)));
    }
  }
}

/// Nine keep a window of 3.2 sigma free of the neighbours (calibration reference 1.2 asks for seven at least).
double sigmasPerCell(BlobSize size) {
  if (size == BlobSize::kFine) return 12;
  return size == BlobSize::kCoarse ? 7 : 9;
}

std::string suffixOf(Pattern pattern, BlobSize size) {
  if (pattern == Pattern::kBlack || pattern == Pattern::kWhite || size == BlobSize::kUsual) return "";
  return size == BlobSize::kFine ? "-fine" : "-coarse";
}

}  // namespace

BlobSize blobSizeFor(devices::Size resolution, double cameraScale) {
  // Light is measured well from a sigma of two camera pixels on (calibration reference 1.2); five leave room for blur.
  if (BlobLayout(resolution, BlobSize::kFine).sigma() * cameraScale >= 5) return BlobSize::kFine;
  return BlobLayout(resolution).sigma() * cameraScale >= 2 ? BlobSize::kUsual : BlobSize::kCoarse;
}

BlobLayout::BlobLayout(devices::Size resolution, BlobSize size)
    : resolution_(resolution),
      size_(size),
      sigma_(std::min(resolution.width / double(kBlobColumns), resolution.height / double(kBlobRows)) /
             sigmasPerCell(size)),
      margin_(2.5 * sigma_) {}

glm::dvec2 BlobLayout::centre(int id) const {
  assert(id >= 1 && id <= kBlobCount);
  const int column = (id - 1) % kBlobColumns;
  const int row = (id - 1) / kBlobColumns;
  return {margin_ + (resolution_.width - 2 * margin_) * column / (kBlobColumns - 1),
          margin_ + (resolution_.height - 2 * margin_) * row / (kBlobRows - 1)};
}

std::vector<Pattern> allPatterns() {
  std::vector<Pattern> patterns;
  for (int i = 0; i < kPatternCount; ++i) patterns.push_back(static_cast<Pattern>(i));
  return patterns;
}

std::string patternName(Pattern pattern) {
  switch (pattern) {
    case Pattern::kBlack:
      return "black";
    case Pattern::kWhite:
      return "white";
    case Pattern::kBlobs:
      return "blobs";
    default:
      return "bit" + std::to_string(static_cast<int>(pattern) - static_cast<int>(Pattern::kBit0));
  }
}

std::string patternDescription(Pattern pattern) {
  switch (pattern) {
    case Pattern::kBlack:
      return "all black";
    case Pattern::kWhite:
      return "all white";
    case Pattern::kBlobs:
      return "100 blobs";
    default:
      return "half of the blobs";
  }
}

devices::Image8 renderPattern(Pattern pattern, const BlobLayout& layout) {
  devices::Image8 image(layout.resolution(), 1);
  if (pattern == Pattern::kBlack) return image;
  if (pattern == Pattern::kWhite) {
    std::ranges::fill(image.samples(), std::uint8_t{255});
    return image;
  }
  for (int id = 1; id <= kBlobCount; ++id) {
    if (shows(pattern, id)) drawBlob(image, layout.centre(id), layout.sigma());
  }
  return image;
}

ProjectedPattern projected(Pattern pattern, const BlobLayout& layout) {
  return {patternName(pattern) + suffixOf(pattern, layout.size()), patternDescription(pattern),
          [pattern, layout] { return renderPattern(pattern, layout); }};
}

}  // namespace pixelflex::calib
