#pragma once

#include <string>

namespace pixelflex::devices {

/// What GLFW says about its last failure on this thread, for messages.
[[nodiscard]] std::string lastGlfwError();

}  // namespace pixelflex::devices
