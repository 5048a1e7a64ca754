#include "devices/camera/raw_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pixelflex::devices {
namespace {

std::size_t bytesPerPixel(RawLayout layout) {
  switch (layout) {
    case RawLayout::kRgb8:
    case RawLayout::kBgr8:
      return 3;
    case RawLayout::kGrey16:
    case RawLayout::kYuyv:
    case RawLayout::kUyvy:
      return 2;
    default:
      return 1;
  }
}

std::uint8_t rounded(double code) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(code, 0.0, 255.0)));
}

void developGrey16(std::span<const std::uint8_t> row, std::span<std::uint8_t> out, int bits) {
  const double scale = 255.0 / ((1 << bits) - 1);
  for (std::size_t x = 0; x < row.size() / 2; ++x) {
    std::fill_n(&out[3 * x], 3, rounded(scale * (row[2 * x] + 256 * row[2 * x + 1])));
  }
}

void developColour(std::span<const std::uint8_t> row, std::span<std::uint8_t> out, bool blueFirst) {
  for (std::size_t i = 0; i < row.size(); ++i) out[blueFirst ? i - i % 3 + 2 - i % 3 : i] = row[i];
}

/// Two pixels share their colour; `light` is 0 where their light comes first, 1 where their colour does.
void developYuv(std::span<const std::uint8_t> row, std::span<std::uint8_t> out, std::size_t light) {
  for (std::size_t x = 0; x < row.size() / 2; ++x) {
    const std::size_t pair = std::min(x / 2 * 4, row.size() - 2);
    const std::size_t last = row.size() - 1;
    const double u = row[std::min(pair + 1 - light, last)] - 128.0;
    const double v = row[std::min(pair + 3 - light, last)] - 128.0;
    const double y = 1.164384 * (row[2 * x + light] - 16.0);
    out[3 * x] = rounded(y + 1.596027 * v);
    out[3 * x + 1] = rounded(y - 0.391762 * u - 0.812968 * v);
    out[3 * x + 2] = rounded(y + 2.017232 * u);
  }
}

/// Which colour a Bayer mosaic has at a pixel: 0 red, 1 green, 2 blue.
int bayerColour(RawLayout layout, int x, int y) {
  const bool redX = layout == RawLayout::kBayerRg8 || layout == RawLayout::kBayerGb8;  // red in even columns
  const bool redY = layout == RawLayout::kBayerRg8 || layout == RawLayout::kBayerGr8;  // red in even rows
  const bool inRedColumn = (x % 2 == 0) == redX;
  const bool inRedRow = (y % 2 == 0) == redY;
  if (inRedColumn != inRedRow) return 1;
  return inRedRow ? 0 : 2;
}

void developBayerPixel(const RawPicture& raw, std::size_t stride, int x, int y, std::uint8_t* out) {
  const int own = bayerColour(raw.layout, x, y);
  std::array<int, 3> sums{};
  std::array<int, 3> counts{};
  for (int v = std::max(0, y - 1); v <= std::min(raw.size.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(raw.size.width - 1, x + 1); ++u) {
      const auto colour = static_cast<std::size_t>(bayerColour(raw.layout, u, v));
      if (static_cast<int>(colour) == own && (u != x || v != y)) continue;
      sums.at(colour) += raw.bytes[static_cast<std::size_t>(v) * stride + static_cast<std::size_t>(u)];
      ++counts.at(colour);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = static_cast<std::uint8_t>((sums.at(c) + counts.at(c) / 2) / std::max(1, counts.at(c)));
  }
}

void developRow(const RawPicture& raw, std::span<const std::uint8_t> row, std::span<std::uint8_t> out) {
  switch (raw.layout) {
    case RawLayout::kGrey16:
      return developGrey16(row, out, raw.bits);
    case RawLayout::kRgb8:
    case RawLayout::kBgr8:
      return developColour(row, out, raw.layout == RawLayout::kBgr8);
    case RawLayout::kYuyv:
    case RawLayout::kUyvy:
      return developYuv(row, out, raw.layout == RawLayout::kYuyv ? 0 : 1);
    default:
      for (std::size_t x = 0; x < row.size(); ++x) std::fill_n(&out[3 * x], 3, row[x]);
  }
}

}  // namespace

Image8 developed(const RawPicture& raw) {
  const std::size_t rowBytes = bytesPerPixel(raw.layout) * static_cast<std::size_t>(raw.size.width);
  const std::size_t stride = raw.stride == 0 ? rowBytes : raw.stride;
  Image8 image(raw.size, 3);
  if (stride < rowBytes || raw.bytes.size() < stride * static_cast<std::size_t>(raw.size.height - 1) + rowBytes) {
    throw std::runtime_error("a frame of " + std::to_string(raw.bytes.size()) + " bytes, too few for " +
                             std::to_string(raw.size.width) + "x" + std::to_string(raw.size.height) + " pixels");
  }
  const bool mosaic = raw.layout >= RawLayout::kBayerRg8;
  for (int y = 0; y < raw.size.height; ++y) {
    if (!mosaic) developRow(raw, raw.bytes.subspan(static_cast<std::size_t>(y) * stride, rowBytes), image.row(y));
    for (int x = 0; mosaic && x < raw.size.width; ++x) developBayerPixel(raw, stride, x, y, &image.at(x, y));
  }
  return image;
}

}  // namespace pixelflex::devices
