#pragma once

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Something that photographs the wall. Not thread-safe: one thread owns a camera.
class Camera {
 public:
  Camera() = default;
  virtual ~Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  /// The extent of every photograph.
  [[nodiscard]] virtual Size size() const = 0;

  /// A photograph, three channels, whose exposure began after the call. Throws std::runtime_error saying which camera
  /// failed and how.
  [[nodiscard]] virtual Image8 shoot() = 0;
};

}  // namespace pixelflex::devices
