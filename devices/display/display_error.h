#pragma once

#include <stdexcept>
#include <string>

namespace pixelflex::devices {

/// No context, no window, no monitor, or the graphics driver refused something. what() says what was asked for, what is
/// missing and what to do.
class DisplayError : public std::runtime_error {
 public:
  explicit DisplayError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace pixelflex::devices
