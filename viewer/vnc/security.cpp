#include "viewer/vnc/security.h"

#include <array>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

constexpr std::array<const char*, 4> kNames{"none", "vnc", "tls", "x509"};

}  // namespace

SecurityLevel parseSecurityLevel(std::string_view text) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (text == kNames[i]) return static_cast<SecurityLevel>(i);
  }
  throw std::invalid_argument("no such security level: " + std::string(text) + " (there are none, vnc, tls, x509)");
}

const char* nameOf(SecurityLevel level) {
  return kNames.at(static_cast<std::size_t>(level));
}

}  // namespace pixelflex::viewer
