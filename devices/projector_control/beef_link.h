#pragma once

#include <cstdint>
#include <string>

#include "devices/transport/line.h"

namespace pixelflex::devices {

/// How BE EF frames travel: as they are over serial lines and TCP port 23, or wrapped over TCP port 9715, with a check
/// sum, a number that comes back with the reply, and MD5 authentication where the projector asks for it. One thread
/// uses it at a time.
class BeefLink {
 public:
  static constexpr int kNetworkPort = 9715;

  /// `line` must outlive it. `password` is only for the network port, and may be empty.
  BeefLink(Line& line, std::string password);

  /// The reply from its first byte on, without what is around it. With `mayRepeat` once more when it got lost. Throws
  /// LineError.
  [[nodiscard]] std::string ask(const std::string& frame, bool mayRepeat);

 private:
  [[nodiscard]] std::string tryAsk(const std::string& frame);
  [[nodiscard]] std::string login();

  Line& line_;
  bool wrapped_;
  std::string password_;
  std::uint64_t session_ = 0;  // the connection that was logged in to
  std::uint8_t number_ = 0;
};

/// 02 0D, the frame, what makes the sum of all bytes zero, and the number.
[[nodiscard]] std::string wrappedBeefFrame(const std::string& frame, std::uint8_t number);

}  // namespace pixelflex::devices
