#pragma once

#include <string>

#include "devices/image/size.h"

namespace pixelflex::calib {

/// Figures and sizes as messages write them.
[[nodiscard]] std::string rounded(double value, int digits);
[[nodiscard]] std::string sizeText(devices::Size size);
/// "1 mask", "2 masks".
[[nodiscard]] std::string count(std::size_t number, const std::string& noun);

}  // namespace pixelflex::calib
