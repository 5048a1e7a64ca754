#pragma once

#include <string>

#include "devices/image/image.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {

/// The Xorg that drives real outputs, with one that exists in memory alone: unlike Xvfb's it keeps a look-up table.
[[nodiscard]] XServer::Command dummyXorg(devices::Size size);

/// The table of the display's first output: red, green and blue in a row; empty when there is none.
[[nodiscard]] std::vector<std::uint16_t> outputTables(const std::string& display);

}  // namespace pixelflex::testing
