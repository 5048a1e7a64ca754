#pragma once

#include <string>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Something that throws a picture onto the wall. Not thread-safe: one thread owns a projector.
class Projector {
 public:
  Projector() = default;
  virtual ~Projector() = default;
  Projector(const Projector&) = delete;
  Projector& operator=(const Projector&) = delete;

  [[nodiscard]] virtual const std::string& name() const = 0;
  [[nodiscard]] virtual Size resolution() const = 0;

  /// Shows an image of exactly resolution(), one or three channels of device codes, and returns once it is on the wall.
  virtual void show(const Image8& frame) = 0;

  /// Shows black.
  virtual void blank() = 0;
};

}  // namespace pixelflex::devices
