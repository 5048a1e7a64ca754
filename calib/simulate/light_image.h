#pragma once

#include "calib/simulate/rig.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What leaves a projector: four floats a pixel (red, green, blue, unused) with a dark apron around the frame for the
/// light that defocus carries over its edge. Interpolated linearly, it is the frame's square pixels convolved with the
/// defocus, to second order.
class LightImage {
 public:
  static constexpr int kChannels = 4;

  enum class Leak { kWith, kWithout };
  /// channelLight of every code, with or without the part that also black lets through. One or three channels of codes.
  LightImage(const SimulatedProjectorSpec& projector, const devices::Image8& frame, Leak leak);
  /// 1 in every channel over the whole frame.
  explicit LightImage(const SimulatedProjectorSpec& projector);

  [[nodiscard]] const float* data() const { return light_.samples().data(); }
  [[nodiscard]] int width() const { return light_.width(); }
  [[nodiscard]] int height() const { return light_.height(); }
  [[nodiscard]] int apron() const { return apron_; }

 private:
  void defocus(double sigma);

  int apron_;
  devices::ImageF light_;
};

}  // namespace pixelflex::calib
