#pragma once

#include <filesystem>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Largest width or height accepted from a file, so that a hostile header cannot make us allocate without bound.
inline constexpr int kMaxImageExtent = 32768;

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
