#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "devices/simulate/simulated_device.h"

namespace pixelflex::devices {

/// The kinds of simulators, as drivers name them.
[[nodiscard]] std::vector<std::string> simulatorKinds();

/// A simulator by its text, `KIND` or `KIND?option=value&…` such as `ptu?fault=stuck`. Throws std::invalid_argument,
/// whose message says what there is.
[[nodiscard]] std::unique_ptr<SimulatedDevice> makeSimulator(std::string_view text);

}  // namespace pixelflex::devices
