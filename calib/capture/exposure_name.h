#pragma once

#include <optional>
#include <string>

namespace pixelflex::calib {

/// The name of a photograph (without ending) of which there are several, by exposure: "red-128@0.0167".
[[nodiscard]] std::string nameWithExposure(const std::string& pattern, double seconds);

/// The pattern of a photograph: what stands before the "@".
[[nodiscard]] std::string patternOfName(const std::string& name);

/// Seconds after the "@": a number, or a fraction with "_" for the stroke (1_60). None where there is neither.
[[nodiscard]] std::optional<double> exposureOfName(const std::string& name);

}  // namespace pixelflex::calib
