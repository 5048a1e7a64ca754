#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// Text made safe inside HTML and SVG, in elements and in attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// A colour that tells neighbouring projectors apart, CSS notation; readable on light and on dark paper.
[[nodiscard]] std::string colourOf(std::size_t projector);

/// The colour of the projector's place in the wall's list; of a name that is not there, grey.
[[nodiscard]] std::string colourOf(const Summary& summary, const std::string& name);

/// The largest of 1, 2 and 5 times a power of ten that does not exceed a positive value.
[[nodiscard]] double roundedDown(double value);

/// "0.05", "200": a rounded number without idle zeros.
[[nodiscard]] std::string plain(double value);

/// Wall units in words: those of wall.yaml; desktop pixels on a flat wall.
[[nodiscard]] std::string unitsOf(const Wall& wall);

}  // namespace pixelflex::calib
