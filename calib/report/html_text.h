#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

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

/// A small square of a projector's colour, before its name.
[[nodiscard]] std::string chip(const std::string& colour);

/// One of the figures at a glance inside <dl class="facts">.
[[nodiscard]] std::string fact(const std::string& term, const std::string& figure, const std::string& note);

/// A table up to its first row; `heads` are HTML. kCloseTable ends it.
[[nodiscard]] std::string openTable(const std::string& label, const std::vector<std::string>& heads);
inline constexpr const char* kCloseTable = "</tbody></table></div>\n";

}  // namespace pixelflex::calib
