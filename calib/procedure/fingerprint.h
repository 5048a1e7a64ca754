#pragma once

#include <string>
#include <string_view>

namespace pixelflex::calib {

/// A short hexadecimal text that differs when its inputs do (64-bit FNV-1a: against accidents, not attackers).
class Fingerprint {
 public:
  Fingerprint& add(std::string_view text);
  Fingerprint& add(double number);
  [[nodiscard]] std::string text() const;

 private:
  unsigned long long hash_ = 14695981039346656037ULL;
};

}  // namespace pixelflex::calib
