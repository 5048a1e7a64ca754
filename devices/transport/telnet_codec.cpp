#include "devices/transport/telnet_codec.h"

namespace pixelflex::devices {
namespace {

constexpr unsigned char kIac = 255;
constexpr unsigned char kSb = 250;
constexpr unsigned char kSe = 240;
constexpr std::size_t kLongestSub = 256;

}  // namespace

TelnetCodec::Decoded TelnetCodec::decode(std::string_view bytes) {
  Decoded decoded;
  for (const char byte : bytes) take(static_cast<unsigned char>(byte), decoded);
  return decoded;
}

void TelnetCodec::take(unsigned char byte, Decoded& decoded) {
  switch (state_) {
    case State::kData:
      if (byte == kIac) {
        state_ = State::kCommand;
      } else {
        decoded.data += static_cast<char>(byte);
      }
      return;
    case State::kCommand:
      return takeCommand(byte, decoded);
    case State::kOption:
      decoded.commands.push_back({verb_, byte, {}});
      state_ = State::kData;
      return;
    case State::kSub:
    case State::kSubCommand:
      return takeInSub(byte, decoded);
  }
}

void TelnetCodec::takeCommand(unsigned char byte, Decoded& decoded) {
  state_ = State::kData;
  if (byte == kIac) decoded.data += static_cast<char>(kIac);
  if (byte == kSb) {
    sub_.clear();
    state_ = State::kSub;
  }
  if (byte < kWill || byte == kIac) return;  // others have no option
  verb_ = byte;
  state_ = State::kOption;
}

void TelnetCodec::takeInSub(unsigned char byte, Decoded& decoded) {
  const bool afterIac = state_ == State::kSubCommand;
  state_ = State::kSub;
  if (!afterIac && byte == kIac) {
    state_ = State::kSubCommand;
  } else if (afterIac && byte == kSe) {
    if (!sub_.empty()) decoded.commands.push_back({0, static_cast<unsigned char>(sub_.front()), sub_.substr(1)});
    state_ = State::kData;
  } else if (sub_.size() < kLongestSub) {
    sub_ += static_cast<char>(byte);
  }
}

std::string TelnetCodec::encode(std::string_view data) {
  std::string bytes;
  for (const char byte : data) {
    bytes += byte;
    if (static_cast<unsigned char>(byte) == kIac) bytes += byte;
  }
  return bytes;
}

std::string TelnetCodec::command(unsigned char verb, unsigned char option) {
  return {static_cast<char>(kIac), static_cast<char>(verb), static_cast<char>(option)};
}

std::string TelnetCodec::subnegotiation(unsigned char option, std::string_view value) {
  return std::string{static_cast<char>(kIac), static_cast<char>(kSb), static_cast<char>(option)} + encode(value) +
         std::string{static_cast<char>(kIac), static_cast<char>(kSe)};
}

}  // namespace pixelflex::devices
