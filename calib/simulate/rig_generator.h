#pragma once

#include <cstdint>

#include "calib/simulate/rig.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// A wall as a person sets it up by hand: a grid of projectors p1, p2, … (row by row), each aimed casually (yaw and
/// pitch up to 8 degrees, roll up to 2.5) so that neighbours overlap by 10 to 30 % of a frame, with lenses, responses,
/// brightness and white balance that differ; markers above and below the picture; an oblique camera that sees all of
/// it. The same seed gives the same rig.
[[nodiscard]] Rig casualRig(int columns, int rows, devices::Size resolution, std::uint32_t seed,
                            devices::Size cameraSize = {1920, 1080});

/// Eight 1024x768 projectors, four by two, and a 1920x1080 camera: the wall of the PixelFlex report.
[[nodiscard]] Rig reportRig(std::uint32_t seed);

/// Two 640x480 projectors side by side and a 960x600 camera, for quick tries.
[[nodiscard]] Rig miniRig(std::uint32_t seed);

}  // namespace pixelflex::calib
