#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pixelflex::devices {

/// The Telnet protocol in BINARY mode (RFC 854, 856) as far as a serial line over the network needs it: separates data
/// from commands. Pure; bounded, whatever arrives.
class TelnetCodec {
 public:
  static constexpr unsigned char kWill = 251;
  static constexpr unsigned char kWont = 252;
  static constexpr unsigned char kDo = 253;
  static constexpr unsigned char kDont = 254;
  static constexpr unsigned char kBinary = 0;
  static constexpr unsigned char kEcho = 1;
  static constexpr unsigned char kSuppressGoAhead = 3;
  static constexpr unsigned char kComPort = 44;  // RFC 2217

  struct Command {
    unsigned char verb = 0;    // kWill … kDont; 0 for a subnegotiation
    unsigned char option = 0;  // its first byte for a subnegotiation
    std::string value;         // the rest of a subnegotiation
    bool operator==(const Command&) const = default;
  };
  struct Decoded {
    std::string data;
    std::vector<Command> commands;
  };

  /// Takes bytes as they come, cut anywhere.
  [[nodiscard]] Decoded decode(std::string_view bytes);

  [[nodiscard]] static std::string encode(std::string_view data);
  [[nodiscard]] static std::string command(unsigned char verb, unsigned char option);
  [[nodiscard]] static std::string subnegotiation(unsigned char option, std::string_view value);

 private:
  enum class State { kData, kCommand, kOption, kSub, kSubCommand };
  void take(unsigned char byte, Decoded& decoded);
  void takeCommand(unsigned char byte, Decoded& decoded);
  void takeInSub(unsigned char byte, Decoded& decoded);

  State state_ = State::kData;
  unsigned char verb_ = 0;
  std::string sub_;
};

}  // namespace pixelflex::devices
