#pragma once

#include <chrono>

namespace pixelflex::viewer {

/// The processor time that the calling thread has used so far.
[[nodiscard]] std::chrono::nanoseconds threadTime();

}  // namespace pixelflex::viewer
