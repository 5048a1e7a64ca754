#pragma once

#include <stdexcept>
#include <string>

namespace pixelflex::viewer {

/// What somebody asked for from afar cannot be done; the message says why and what to do.
class RemoteError : public std::runtime_error {
 public:
  enum class Kind {
    kWrong,      // it makes no sense
    kUnknown,    // there is no such thing
    kNotNow,     // something else is in the way
    kImpossible  // no device of this wall can
  };
  RemoteError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace pixelflex::viewer
