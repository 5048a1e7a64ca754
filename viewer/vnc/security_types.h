#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "viewer/vnc/security.h"

namespace pixelflex::viewer {

/// The protocol's numbers of the security types that are known here; those from 256 are sub-types of VeNCrypt.
enum SecurityNumber : std::uint32_t {
  kRefusedType = 0,
  kNoneType = 1,
  kVncAuthType = 2,
  kVeNCryptType = 19,
  kTlsNoneType = 257,
  kTlsVncType = 258,
  kTlsPlainType = 259,
  kX509NoneType = 260,
  kX509VncType = 261,
  kX509PlainType = 262,
};

/// What a server wants to know.
enum class Login { kNothing, kPassword, kUserAndPassword };

struct SecurityType {
  std::uint32_t number = kNoneType;
  const char* name = "None";
  SecurityLevel level = SecurityLevel::kNone;
  Login login = Login::kNothing;
};

/// The best of the types that a server offers, or null when all are below `require` or unknown. The level counts
/// first, then whether the login can be had: `userGiven` prefers one with a user's name, otherwise the one that asks
/// for least. A password in the clear, VeNCrypt's type 256, is unknown on purpose.
[[nodiscard]] const SecurityType* chooseSecurityType(std::span<const std::uint32_t> offered, SecurityLevel require,
                                                     bool userGiven);

/// For people: "VncAuth, TLSVnc, 30".
[[nodiscard]] std::string describeSecurityTypes(std::span<const std::uint32_t> offered);

}  // namespace pixelflex::viewer
