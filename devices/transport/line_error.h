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

/// Why a request got no reply, to be handed from thread to thread.
struct LineProblem {
  LineFailure failure = LineFailure::kLost;
  std::string message;  // names the line, says what is wrong and what to look at
};

/// A request got no reply.
class LineError : public std::runtime_error {
 public:
  explicit LineError(const LineProblem& problem) : std::runtime_error(problem.message), failure_(problem.failure) {}
  [[nodiscard]] LineFailure failure() const { return failure_; }

 private:
  LineFailure failure_;
};

}  // namespace pixelflex::devices
