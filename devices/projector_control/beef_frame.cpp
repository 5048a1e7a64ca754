#include "devices/projector_control/beef_frame.h"

namespace pixelflex::devices {
namespace {

std::string lowFirst(std::uint16_t word) {
  return {static_cast<char>(word & 0xFFU), static_cast<char>(word >> 8U)};
}

/// For one byte of the remainder.
constexpr std::array<std::uint16_t, 256> kTable = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint16_t word = static_cast<std::uint16_t>(i);
    for (int bit = 0; bit < 8; ++bit) {
      word = static_cast<std::uint16_t>((word & 1U) != 0 ? word >> 1U ^ 0xA001U : word >> 1U);
    }
    table[i] = word;
  }
  return table;
}();

}  // namespace

std::string beefFrame(BeefOperation operation, std::uint16_t type, std::uint16_t value, std::uint8_t packet) {
  std::string frame = {'\xBE', '\xEF', static_cast<char>(packet), 6, 0, 0, 0};
  frame += lowFirst(static_cast<std::uint16_t>(operation)) + lowFirst(type) + lowFirst(value);
  std::uint16_t remainder = 0xFFFF;
  for (const char byte : frame) {
    const std::uint16_t place = (remainder ^ static_cast<unsigned char>(byte)) & 0xFFU;
    remainder = static_cast<std::uint16_t>(remainder >> 8U ^ kTable.at(place));
  }
  frame[5] = static_cast<char>(remainder >> 8U);
  frame[6] = static_cast<char>(remainder & 0xFFU);
  return frame;
}

}  // namespace pixelflex::devices
