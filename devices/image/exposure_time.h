#pragma once

#include <filesystem>
#include <optional>

namespace pixelflex::devices {

/// The exposure time in seconds that a camera wrote into a JPEG: Exif ShutterSpeedValue where it agrees with
/// ExposureTime, which many cameras round (1/60 stands for 1/64), else the latter; none in other files, or where it
/// says nothing. Never throws, whatever the file.
[[nodiscard]] std::optional<double> exposureTime(const std::filesystem::path& path);

}  // namespace pixelflex::devices
