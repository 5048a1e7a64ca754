#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace pixelflex::viewer {

/// Where the viewer is, line by line from a descriptor: "X Y Z" as for --eye, what else stands there is passed over.
class ModelTracker {
 public:
  explicit ModelTracker(int descriptor) : descriptor_(descriptor) {}

  /// Takes what can be read without waiting: the last place told.
  [[nodiscard]] std::optional<glm::dvec3> read();
  /// Nothing comes any more.
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
  std::string rest_;  // of a line
  bool ended_ = false;
};

}  // namespace pixelflex::viewer
