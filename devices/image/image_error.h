#pragma once

#include <stdexcept>
#include <string>

namespace pixelflex::devices {

/// An image file could not be read or written. what() names the file and says what is wrong with it.
class ImageError : public std::runtime_error {
 public:
  explicit ImageError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace pixelflex::devices
