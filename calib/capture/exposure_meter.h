#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/camera/camera.h"
#include "devices/camera/operator.h"
#include "devices/projector/projector.h"

namespace pixelflex::calib {

/// A person at the wall, with a light meter: arranges as that person does, then exposes a camera for the scene. In the
/// dark it is the white of the brightest projector that decides, in the light the wall as it is; either is measured
/// once and stays. Without an exposure control nothing is set.
class MeteredPerson final : public devices::Operator {
 public:
  /// All must outlive this. `name`: the camera's, for messages.
  MeteredPerson(devices::Operator& person, devices::Camera& camera, std::vector<devices::Projector*> projectors,
                std::string name);

  /// Projectors are black before and after. Throws CaptureError when no exposure of the camera's suits.
  [[nodiscard]] bool arrange(devices::Scene scene, int index) override;
  [[nodiscard]] bool placeCamera(int place) override { return person_.placeCamera(place); }

 private:
  [[nodiscard]] double meterDark();
  [[nodiscard]] double suitable(double start);

  devices::Operator& person_;
  devices::Camera& camera_;
  std::vector<devices::Projector*> projectors_;
  std::string name_;
  std::optional<double> dark_;  // seconds
  std::optional<double> lit_;
};

/// The code that all but one in two thousand pixels stay at or below, in their brightest channel.
[[nodiscard]] int peakOf(const devices::Image8& photo);

}  // namespace pixelflex::calib
