#include "calib/store/yaml_text.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace pixelflex::calib {
namespace {

bool isAlnum(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool isPlain(std::string_view text) {
  constexpr std::array<std::string_view, 9> kReserved = {"null", "Null", "NULL", "true", "false",
                                                         "yes",  "no",   "on",   "off"};
  if (text.empty() || !(isAlnum(text[0]) || text[0] == '/' || text[0] == '_')) return false;
  if (std::ranges::find(kReserved, text) != kReserved.end()) return false;
  return std::ranges::all_of(
      text, [](char c) { return isAlnum(c) || std::string_view("_-./+").find(c) != std::string_view::npos; });
}

std::string escaped(char c) {
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  if (c == '"' || c == '\\') return {'\\', c};
  if (byte >= 0x20 && byte != 0x7F) return {c};
  return {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
}

}  // namespace

std::string yamlNumber(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string yamlList(std::span<const double> values) {
  std::string list = "[";
  for (const double value : values) {
    if (list.size() > 1) list += ", ";
    list += yamlNumber(value);
  }
  return list + "]";
}

std::string yamlList(std::initializer_list<double> values) {
  return yamlList(std::span<const double>(values.begin(), values.size()));
}

std::string yamlText(std::string_view text) {
  if (isPlain(text)) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += escaped(c);
  return quoted + "\"";
}

}  // namespace pixelflex::calib
