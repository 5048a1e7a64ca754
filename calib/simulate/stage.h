#pragma once

#include <memory>
#include <vector>

#include "calib/simulate/projector_light.h"
#include "calib/simulate/rig.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// The screen that the rig speaks of, planar or bent.
[[nodiscard]] std::unique_ptr<const Screen> makeScreen(const Rig& rig);

/// The rig set up: its screen, its projectors' light, and the unit in which radiance is counted.
class Stage {
 public:
  /// `reference`: the rig in whose units radiance is counted, the same room with its projectors set otherwise.
  Stage(Rig rig, const Rig& reference);
  explicit Stage(const Rig& rig) : Stage(rig, rig) {}
  ~Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  [[nodiscard]] const Rig& rig() const { return rig_; }
  [[nodiscard]] const Screen& screen() const { return *screen_; }
  [[nodiscard]] const std::vector<ProjectorLight>& lights() const { return lights_; }
  /// Lumens per square millimetre of the rig's brightest spot of white (of gain 1): radiance 1.
  [[nodiscard]] double unit() const { return unit_; }
  /// Mean radiance of the projectors' white: what "a lit projector's typical white" of Room means.
  [[nodiscard]] double typicalWhite() const { return typicalWhite_; }
  /// Radiance of the brightest spot that one projector can show in any channel.
  [[nodiscard]] double brightestWhite() const { return brightestWhite_; }

 private:
  void measureLight(const Rig& reference);

  Rig rig_;
  std::unique_ptr<const Screen> screen_;
  std::vector<ProjectorLight> lights_;
  double unit_ = 1;
  double typicalWhite_ = 1;
  double brightestWhite_ = 1;
};

/// The largest white-balance gain of the three channels.
[[nodiscard]] double largestGain(const Response& response);

}  // namespace pixelflex::calib
