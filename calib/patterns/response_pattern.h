#pragma once

#include <string>
#include <vector>

#include "calib/patterns/projected_pattern.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// What a projector shows so that its response can be told from photographs at different exposures.

/// The codes of the full fields, from dark to full: 32, enough for 0.5 % between them.
[[nodiscard]] std::vector<int> responseLevels();

/// The whole frame with one channel (0 red, 1 green, 2 blue) at `code`, the others 0: "red-128".
[[nodiscard]] ProjectedPattern levelPattern(devices::Size resolution, int channel, int code);

/// The whole frame at code 0: "response-black".
[[nodiscard]] ProjectedPattern responseBlackPattern(devices::Size resolution);

/// Squares of many greys beside each other, for the camera's own response: "response-chart".
[[nodiscard]] ProjectedPattern responseChart(devices::Size resolution);

/// The wall without the projectors' light, which only a person can arrange: its photograph is called
/// "response-ambient".
[[nodiscard]] std::string ambientName();

/// All that are shown, in the order of a person's work: chart, black, levels of red, green and blue.
[[nodiscard]] std::vector<ProjectedPattern> responsePatterns(devices::Size resolution);

/// Whether a photograph, by its name without ending, belongs to these; "red-128@1_60" does.
[[nodiscard]] bool isOfResponse(const std::string& name);

}  // namespace pixelflex::calib
