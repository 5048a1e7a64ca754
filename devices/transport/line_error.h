#pragma once

#include <stdexcept>
#include <string>

namespace pixelflex::devices {

enum class LineFailure {
  kUnreachable,  // no connection could be made
  kLost,         // the connection ended; whether the request was carried out is not known
  kSilent,       // no reply, or only a part of one, in time
  kInterrupted,  // an urgent request went first, or the line was closed on our side
  kCrowded,      // too many requests wait already
};

/// A request got no reply. The message names the line, says what is wrong and what to look at.
class LineError : public std::runtime_error {
 public:
  LineError(LineFailure failure, const std::string& message) : std::runtime_error(message), failure_(failure) {}
  [[nodiscard]] LineFailure failure() const { return failure_; }

 private:
  LineFailure failure_;
};

}  // namespace pixelflex::devices
