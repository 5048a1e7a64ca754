#pragma once

#include <string>

#include "viewer/remote/wall_remote.h"

namespace pixelflex::viewer {

// JSON texts, indented, a line's end at their ends. Bytes that are no UTF-8 are replaced.

/// The whole wall: {format, version, revision, name, power, partly, muted, frozen, preset, projectors, devices,
/// presets, jobs, calibration}.
[[nodiscard]] std::string stateJson(const WallSnapshot& wall, const WallSummary& summary, const std::string& name,
                                    const std::string& calibrated);
[[nodiscard]] std::string deviceJson(const DeviceState& device);
[[nodiscard]] std::string jobJson(const ConsoleJob& job);
[[nodiscard]] std::string presetsJson(const WallSnapshot& wall);
/// The log's lines with numbers above `after`.
[[nodiscard]] std::string logJson(const WallSnapshot& wall, std::uint64_t after);
/// {"error": …}
[[nodiscard]] std::string errorJson(const std::string& message);

}  // namespace pixelflex::viewer
