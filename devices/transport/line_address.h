#pragma once

#include <string>
#include <string_view>

namespace pixelflex::devices {

enum class LineKind { kSerial, kTcp, kRfc2217, kSimulated };

/// How characters travel on a serial line.
struct SerialFormat {
  int baud = 9600;
  int dataBits = 8;   // 7 or 8
  char parity = 'N';  // N, E or O
  int stopBits = 1;   // 1 or 2
  [[nodiscard]] std::string bits() const;
  bool operator==(const SerialFormat&) const = default;
};

/// Where a device's line ends on our side.
struct LineAddress {
  LineKind kind = LineKind::kSerial;
  std::string path;       // kSerial: the device file
  std::string host;       // kTcp, kRfc2217: a name or a numeric address, without brackets
  int port = 0;           // kTcp, kRfc2217: 1..65535
  std::string simulator;  // kSimulated: what is simulated, with its options: "ptu" or "ptu?seed=2"
  SerialFormat format;    // kSerial, kRfc2217

  /// As a user would write it; parseLineAddress() gives the same value back.
  [[nodiscard]] std::string text() const;
  bool operator==(const LineAddress&) const = default;
};

/// Reads `serial:PATH?baud=9600&bits=8N1`, `tcp://HOST:PORT`, `rfc2217://HOST:PORT?baud=9600&bits=8N1` and `sim:KIND`;
/// hosts may be `[V6]`. `usual` is what the device speaks when the address says nothing. Throws std::invalid_argument,
/// whose message quotes the text and says how to write it.
[[nodiscard]] LineAddress parseLineAddress(std::string_view text, const SerialFormat& usual = {});

}  // namespace pixelflex::devices
