#pragma once

#include <string>
#include <string_view>

namespace pixelflex::devices {

/// What goes before the first command of a connection, after the greeting "PJLINK 1 <random>" (class 1): 32 digits.
[[nodiscard]] std::string pjlinkMd5(std::string_view random, std::string_view password);

/// The same after "PJLINK 2 <random>" (version 2.10): our own random digits and 64 of the digest. `ourRandom` is 32
/// hexadecimal digits, as is theirs.
[[nodiscard]] std::string pjlinkSha256(std::string_view theirRandom, std::string_view ourRandom,
                                       std::string_view password);

/// 32 hexadecimal digits.
[[nodiscard]] std::string pjlinkRandom();

}  // namespace pixelflex::devices
