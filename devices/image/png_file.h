#pragma once

#include <cstdint>
#include <filesystem>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Largest width or height and largest number of pixels accepted from a file, so that a hostile header cannot make us
/// allocate without bound.
inline constexpr int kMaxImageExtent = 32768;
inline constexpr std::int64_t kMaxImageArea = std::int64_t{1} << 28;

/// Throws std::runtime_error when the extent that a header promises is over the bounds, or over the number of pixels
/// that the file could possibly hold.
void checkPromisedSize(std::int64_t width, std::int64_t height, std::uintmax_t pixelsInFile);

/// Reads a PNG of any colour type. Palettes are expanded; 16-bit samples are reduced to eight (rounded); grey stays one
/// channel, alpha is kept. Throws ImageError (missing, truncated, not a PNG, too large).
[[nodiscard]] Image8 readPng8(const std::filesystem::path& path);

/// As readPng8 with 16-bit samples; 8-bit files are widened (v * 257).
[[nodiscard]] Image16 readPng16(const std::filesystem::path& path);

enum class PngEffort {
  kFast,   // for photographs during a capture
  kSmall,  // for what stays on disk
};

/// Writes atomically. Throws ImageError.
void writePng(const std::filesystem::path& path, const Image8& image, PngEffort effort = PngEffort::kFast);
void writePng(const std::filesystem::path& path, const Image16& image, PngEffort effort = PngEffort::kFast);

}  // namespace pixelflex::devices
