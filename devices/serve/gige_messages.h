#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pixelflex::devices {

/// The bytes of GigE Vision's control (GVCP) and stream protocol (GVSP), all numbers big-endian.
using Bytes = std::vector<std::uint8_t>;

enum class GigeCommand : std::uint16_t {
  kDiscovery = 0x0002,
  kResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
};

struct GigeRequest {
  GigeCommand command = GigeCommand::kDiscovery;  // or a value that is none of them
  std::uint16_t id = 0;
  Bytes data;
  /// Number `index` of the data, 0 where there are not so many.
  [[nodiscard]] std::uint32_t number(std::size_t index) const;
  [[nodiscard]] std::size_t numbers() const { return data.size() / 4; }
};
/// None: no request, or a damaged one.
[[nodiscard]] std::optional<GigeRequest> parseGigeRequest(std::span<const std::uint8_t> packet);

enum class GigeStatus : std::uint16_t {
  kSuccess = 0,
  kNotImplemented = 0x8001,
  kInvalidAddress = 0x8003,
  kAccessDenied = 0x8006,
};
[[nodiscard]] Bytes gigeAnswer(const GigeRequest& request, GigeStatus status, const Bytes& data);

void appendNumber(Bytes& bytes, std::uint32_t number);

/// What a frame is sent as.
struct GigeFrame {
  std::uint16_t block = 1;  // never 0
  std::uint64_t timestamp = 0;
  std::uint32_t pixelFormat = 0;
  std::uint32_t width = 0, height = 0, x = 0, y = 0;
  std::size_t packetSize = 1400;  // with the headers of IP and UDP
  Bytes pixels;

  /// A leader, the pixels, a trailer.
  [[nodiscard]] std::uint32_t packets() const;
  [[nodiscard]] Bytes packet(std::uint32_t index) const;

 private:
  [[nodiscard]] std::size_t share() const;
};

}  // namespace pixelflex::devices
