#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace pixelflex::devices {

enum class BeefOperation : std::uint16_t { kSet = 1, kGet = 2, kIncrement = 4, kDecrement = 5, kExecute = 6 };

/// One request of 13 bytes. The check sum is CRC-16/MODBUS over all of them with its own place zero, high byte first;
/// no vendor's manual says so, but it gives all frames that they print.
[[nodiscard]] std::string beefFrame(BeefOperation operation, std::uint16_t type, std::uint16_t value = 0,
                                    std::uint8_t packet = 3);

}  // namespace pixelflex::devices
