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

/// Four 1024x768 projectors, two by two, almost entirely covered by four others (the report's figure 13): p1 under p5
/// and so on.
[[nodiscard]] Rig stackedRig(std::uint32_t seed);

/// Three 1024x768 projectors side by side that stand on their sides, rolled by 90 degrees one way or the other.
[[nodiscard]] Rig portraitRig(std::uint32_t seed);

/// Four 1280x800 projectors, two by two, with a throw of about 0.8, lenses shifted by half a frame and a k1 of -0.1 to
/// -0.15.
[[nodiscard]] Rig shortThrowRig(std::uint32_t seed);

/// A 1024x768 projector p1 and inside its frame p2, of the same resolution at three times the density.
[[nodiscard]] Rig insetRig(std::uint32_t seed);

/// Two pairs of 1024x768 projectors, p1 with p2 and p3 with p4, with dark wall between them.
[[nodiscard]] Rig islandsRig(std::uint32_t seed);

/// Three 1024x768 projectors: p2 below p1, p3 to the right of p2.
[[nodiscard]] Rig lShapedRig(std::uint32_t seed);

/// A cylindrical screen, hollow with a radius of 3 m, and three 1920x1080 projectors side by side on 70 degrees of it,
/// overlapping by 15 to 25 %; five markers above and five below; a 1920x1080 camera that sees all of it.
[[nodiscard]] Rig cylinderRig(std::uint32_t seed);

/// Eighteen 1024x768 projectors, six by three, too many for one photograph: a 1920x1080 camera with about 0.6 pixels
/// per projector pixel at six places, three by two. Every projector lies wholly in the picture from at least one place,
/// most of them from several; eighteen markers around the picture.
[[nodiscard]] Rig largeRig(std::uint32_t seed);

}  // namespace pixelflex::calib
