#include "viewer/vnc/security_types.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pixelflex::viewer {
namespace {

constexpr std::array<SecurityType, 8> kTypes{{
    {kNoneType, "None", SecurityLevel::kNone, Login::kNothing},
    {kVncAuthType, "VncAuth", SecurityLevel::kVnc, Login::kPassword},
    {kTlsNoneType, "TLSNone", SecurityLevel::kTls, Login::kNothing},
    {kTlsVncType, "TLSVnc", SecurityLevel::kTls, Login::kPassword},
    {kTlsPlainType, "TLSPlain", SecurityLevel::kTls, Login::kUserAndPassword},
    {kX509NoneType, "X509None", SecurityLevel::kX509, Login::kNothing},
    {kX509VncType, "X509Vnc", SecurityLevel::kX509, Login::kPassword},
    {kX509PlainType, "X509Plain", SecurityLevel::kX509, Login::kUserAndPassword},
}};

const SecurityType* findType(std::uint32_t number) {
  const auto* found = std::ranges::find(kTypes, number, &SecurityType::number);
  return found == kTypes.end() ? nullptr : found;
}

std::string nameOf(std::uint32_t number) {
  if (number == kVeNCryptType) return "VeNCrypt";
  if (number == 256) return "Plain";
  const SecurityType* type = findType(number);
  return type != nullptr ? type->name : std::to_string(number);
}

}  // namespace

const SecurityType* chooseSecurityType(std::span<const std::uint32_t> offered, SecurityLevel require, bool userGiven) {
  const auto rank = [userGiven](const SecurityType& type) {
    const int asks = static_cast<int>(type.login);
    return std::pair(type.level, userGiven ? asks : -asks);
  };
  const SecurityType* best = nullptr;
  for (const std::uint32_t number : offered) {
    const SecurityType* type = findType(number);
    if (type == nullptr || type->level < require) continue;
    if (best == nullptr || rank(*best) < rank(*type)) best = type;
  }
  return best;
}

std::string describeSecurityTypes(std::span<const std::uint32_t> offered) {
  std::string text;
  for (const std::uint32_t number : offered) text += (text.empty() ? "" : ", ") + nameOf(number);
  return text.empty() ? "nothing" : text;
}

}  // namespace pixelflex::viewer
