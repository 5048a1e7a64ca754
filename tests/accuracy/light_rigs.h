#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "calib/simulate/rig.h"

namespace pixelflex::calib {

/// A kind of rig of the light table; every seed gives another of the kind.
struct LightRig {
  std::string name;
  std::function<Rig(std::uint32_t seed)> make;
  bool inset = false;     // a dense projector inside another: its border has a row of its own
  bool response = false;  // projectors whose response the camera measures
  bool text = false;      // large enough to read on
};

[[nodiscard]] const std::vector<LightRig>& lightRigs();

/// The same rig with projectors whose light differs as much as that of projectors from the shop does: white levels by
/// 15 % and gains by 8 % either way, gamma 1.9 to 2.5 with a toe, 0.1 to 0.4 % of leak, 20 to 40 % of vignetting.
[[nodiscard]] Rig withUnlikeLight(Rig rig, std::uint32_t seed);

/// The same rig with every projector in focus.
[[nodiscard]] Rig focused(Rig rig);

/// The same rig after every other projector's picture has slipped sideways by so many of its pixels.
[[nodiscard]] Rig slipped(Rig rig, double pixels);

}  // namespace pixelflex::calib
