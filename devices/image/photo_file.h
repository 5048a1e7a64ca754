#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Reads a photograph: PNG or JPEG by content, always three channels (grey is spread, alpha dropped). A truncated or
/// damaged JPEG is an error, not a grey rest. Throws ImageError naming the file.
[[nodiscard]] Image8 readPhoto(const std::filesystem::path& path);

/// A photograph that a camera sent as JPEG, likewise. Throws ImageError.
[[nodiscard]] Image8 readJpeg(std::span<const std::uint8_t> bytes);

}  // namespace pixelflex::devices
