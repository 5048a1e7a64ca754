#include "devices/serve/gige_messages.h"

#include <algorithm>
#include <cassert>

namespace pixelflex::devices {
namespace {

constexpr std::size_t kHeader = 8;
constexpr std::size_t kPacketOverhead = 20 + 8 + kHeader;  // of IP, UDP and the stream protocol
constexpr std::uint8_t kIsRequest = 0x42;
constexpr std::uint32_t kImage = 1;

void append16(Bytes& bytes, std::uint32_t number) {
  bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(number));
}

std::uint16_t read16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

}  // namespace

void appendNumber(Bytes& bytes, std::uint32_t number) {
  append16(bytes, number >> 16U);
  append16(bytes, number);
}

std::uint32_t GigeRequest::number(std::size_t index) const {
  if (index >= numbers()) return 0;
  const std::uint32_t high = read16(data, 4 * index);
  return high << 16U | read16(data, 4 * index + 2);
}

std::optional<GigeRequest> parseGigeRequest(std::span<const std::uint8_t> packet) {
  if (packet.size() < kHeader || packet[0] != kIsRequest) return std::nullopt;
  const std::size_t length = read16(packet, 4);
  if (packet.size() < kHeader + length) return std::nullopt;
  const auto data = packet.subspan(kHeader, length);
  return GigeRequest{static_cast<GigeCommand>(read16(packet, 2)), read16(packet, 6), Bytes(data.begin(), data.end())};
}

Bytes gigeAnswer(const GigeRequest& request, GigeStatus status, const Bytes& data) {
  Bytes answer;
  append16(answer, static_cast<std::uint16_t>(status));
  append16(answer, static_cast<std::uint16_t>(request.command) + 1U);
  append16(answer, static_cast<std::uint32_t>(data.size()));
  append16(answer, request.id);
  answer.insert(answer.end(), data.begin(), data.end());
  return answer;
}

std::size_t GigeFrame::share() const {
  assert(packetSize > kPacketOverhead);
  return packetSize - kPacketOverhead;
}

std::uint32_t GigeFrame::packets() const {
  return static_cast<std::uint32_t>((pixels.size() + share() - 1) / share()) + 2;
}

Bytes GigeFrame::packet(std::uint32_t index) const {
  const bool leads = index == 0;
  const bool trails = index + 1 == packets();
  Bytes bytes;
  append16(bytes, 0);
  append16(bytes, block);
  const std::uint32_t kind = leads ? 1 : trails ? 2 : 3;
  appendNumber(bytes, kind << 24U | index);
  if (leads) {
    for (const auto number : {kImage, static_cast<std::uint32_t>(timestamp >> 32U),
                              static_cast<std::uint32_t>(timestamp), pixelFormat, width, height, x, y, 0U}) {
      appendNumber(bytes, number);
    }
  } else if (trails) {
    appendNumber(bytes, kImage);
    appendNumber(bytes, height);
  } else {
    const std::size_t begin = (index - 1) * share();
    const std::size_t end = std::min(pixels.size(), begin + share());
    bytes.insert(bytes.end(), pixels.begin() + static_cast<std::ptrdiff_t>(begin),
                 pixels.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return bytes;
}

}  // namespace pixelflex::devices
