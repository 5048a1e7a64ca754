#include "calib/procedure/wording.h"

#include <array>
#include <cstdio>

namespace pixelflex::calib {

std::string rounded(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string sizeText(devices::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string count(std::size_t number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

}  // namespace pixelflex::calib
