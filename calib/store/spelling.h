#pragma once

#include <set>
#include <string>
#include <string_view>

namespace pixelflex::calib {

/// The known word that somebody who typed another most probably meant: two letters off at most, in long words a third
/// of them. Empty when none is near.
[[nodiscard]] std::string nearestWord(std::string_view typed, const std::set<std::string>& known);

}  // namespace pixelflex::calib
