#include "calib/procedure/fingerprint.h"

#include <array>
#include <charconv>

namespace pixelflex::calib {

Fingerprint& Fingerprint::add(std::string_view text) {
  const auto mix = [this](unsigned char byte) { hash_ = (hash_ ^ byte) * 1099511628211ULL; };
  for (const char c : text) mix(static_cast<unsigned char>(c));
  mix(0xFF);  // so that "ab" + "c" and "a" + "bc" differ
  return *this;
}

Fingerprint& Fingerprint::add(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return add(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

std::string Fingerprint::text() const {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), hash_, 16).ptr;
  return {digits.data(), end};
}

}  // namespace pixelflex::calib
