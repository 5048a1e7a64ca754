#pragma once

#include <stdexcept>
#include <string>

namespace pixelflex::viewer {

/// A plan that cannot be drawn or a wall too large for the graphics memory. what() names the output and the limit.
class RendererError : public std::runtime_error {
 public:
  explicit RendererError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace pixelflex::viewer
