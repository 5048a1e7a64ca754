#pragma once

#include "devices/image/image.h"

namespace pixelflex::devices {

/// Exposure times that a camera can be set to, seconds.
struct ExposureRange {
  double shortest = 0;
  double longest = 0;
};

/// What a camera whose exposure can be set from here offers besides photographs. Nothing else about the pictures
/// changes with the exposure: gain, aperture and white balance stay.
class ExposureControl {
 public:
  ExposureControl() = default;
  virtual ~ExposureControl() = default;
  ExposureControl(const ExposureControl&) = delete;
  ExposureControl& operator=(const ExposureControl&) = delete;

  [[nodiscard]] virtual ExposureRange exposureRange() const = 0;

  /// Of the next photograph, seconds.
  [[nodiscard]] virtual double exposure() = 0;

  /// Sets the exposure of the next photographs as nearly to `seconds` as the camera can, and returns what it is now.
  virtual double setExposure(double seconds) = 0;
};

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

  /// Null when the exposure cannot be set from here. Lives as long as the camera.
  [[nodiscard]] virtual ExposureControl* exposureControl() { return nullptr; }
};

}  // namespace pixelflex::devices
