#include "devices/transport/line_address.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>

namespace pixelflex::devices {
namespace {

constexpr std::size_t kLongest = 512;
constexpr std::array kRates = {300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw std::invalid_argument("\"" + std::string(text.substr(0, kLongest)) + "\": " + why +
                              "; write serial:/dev/ttyUSB0?baud=9600, tcp://HOST:PORT, rfc2217://HOST:PORT?baud=9600 "
                              "or sim:KIND");
}

std::optional<int> wholeNumber(std::string_view digits) {
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

bool hasOddCharacters(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\x7f'; });
}

void readBits(std::string_view text, std::string_view value, SerialFormat& format) {
  constexpr std::string_view kParities = "NEO";
  const bool sound = value.size() == 3 && (value[0] == '7' || value[0] == '8') &&
                     kParities.find(value[1]) != std::string_view::npos && (value[2] == '1' || value[2] == '2');
  if (!sound) refuse(text, "bits are written 8N1: 7 or 8 data bits, parity N, E or O, 1 or 2 stop bits");
  format.dataBits = value[0] - '0';
  format.parity = value[1];
  format.stopBits = value[2] - '0';
}

void readBaud(std::string_view text, std::string_view value, SerialFormat& format) {
  const auto baud = wholeNumber(value);
  if (!baud || std::ranges::find(kRates, *baud) == kRates.end()) {
    refuse(text, "baud is 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600 or 115200");
  }
  format.baud = *baud;
}

void readFormat(std::string_view text, std::string_view options, SerialFormat& format) {
  while (!options.empty()) {
    const auto cut = options.find('&');
    const std::string_view option = options.substr(0, cut);
    options = cut == std::string_view::npos ? std::string_view() : options.substr(cut + 1);
    if (option.starts_with("baud=")) {
      readBaud(text, option.substr(5), format);
    } else if (option.starts_with("bits=")) {
      readBits(text, option.substr(5), format);
    } else {
      refuse(text, "there is no option \"" + std::string(option) + "\", only baud=… and bits=…");
    }
  }
}

void readHost(std::string_view text, std::string_view place, LineAddress& address) {
  const auto colon = place.rfind(':');
  if (colon == std::string_view::npos) refuse(text, "the port is missing");
  std::string_view host = place.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    refuse(text, "a numeric IPv6 host goes into brackets");
  }
  if (host.empty()) refuse(text, "the host is missing");
  if (host.find_first_of("[]/@?") != std::string_view::npos) refuse(text, "that is no host name");
  const auto port = wholeNumber(place.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535) refuse(text, "a port is a number from 1 to 65535");
  address.host = host;
  address.port = *port;
}

LineAddress readSerial(std::string_view text, std::string_view rest, const SerialFormat& usual) {
  LineAddress address{.kind = LineKind::kSerial, .format = usual};
  const auto cut = rest.find('?');
  address.path = rest.substr(0, cut);
  if (address.path.empty()) refuse(text, "the device file is missing");
  if (cut != std::string_view::npos) readFormat(text, rest.substr(cut + 1), address.format);
  return address;
}

LineAddress readNetwork(std::string_view text, std::string_view rest, LineKind kind, const SerialFormat& usual) {
  LineAddress address{.kind = kind};
  const auto cut = rest.find('?');
  readHost(text, rest.substr(0, cut), address);
  if (kind == LineKind::kRfc2217) address.format = usual;
  if (cut == std::string_view::npos) return address;
  if (kind == LineKind::kTcp) refuse(text, "a raw port has no options: its speed is set at the port server");
  readFormat(text, rest.substr(cut + 1), address.format);
  return address;
}

}  // namespace

std::string SerialFormat::bits() const {
  return std::to_string(dataBits) + parity + std::to_string(stopBits);
}

std::string LineAddress::text() const {
  const std::string options = "?baud=" + std::to_string(format.baud) + "&bits=" + format.bits();
  if (kind == LineKind::kSimulated) return "sim:" + simulator;
  if (kind == LineKind::kSerial) return "serial:" + path + options;
  const bool brackets = host.find(':') != std::string::npos;
  const std::string place = (brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
  return kind == LineKind::kTcp ? "tcp://" + place : "rfc2217://" + place + options;
}

LineAddress parseLineAddress(std::string_view text, const SerialFormat& usual) {
  if (text.size() > kLongest) refuse(text, "that is too long for an address");
  if (hasOddCharacters(text)) refuse(text, "an address has no blanks or control characters");
  if (text.starts_with("serial:")) return readSerial(text, text.substr(7), usual);
  if (text.starts_with("tcp://")) return readNetwork(text, text.substr(6), LineKind::kTcp, usual);
  if (text.starts_with("rfc2217://")) return readNetwork(text, text.substr(10), LineKind::kRfc2217, usual);
  if (!text.starts_with("sim:")) refuse(text, "that is no address of a line");
  if (text.size() == 4) refuse(text, "what is to be simulated is missing");
  return {.kind = LineKind::kSimulated, .simulator = std::string(text.substr(4))};
}

}  // namespace pixelflex::devices
