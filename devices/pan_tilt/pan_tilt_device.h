#pragma once

#include <memory>

#include "devices/control/device.h"
#include "devices/pan_tilt/pan_tilt_unit.h"

namespace pixelflex::devices {

/// A pan-tilt unit as a device with settings: pan and tilt in degrees and, as pan_counts and tilt_counts, in the unit's
/// own counts; pan_speed, tilt_speed, pan_acceleration, tilt_acceleration; limits. Actions: home (both axes to 0) and
/// reset.
[[nodiscard]] std::unique_ptr<Device> makePanTiltDevice(LineLoop& loop, const LineAddress& address,
                                                        const std::string& name);

}  // namespace pixelflex::devices
