#pragma once

#include <cstdint>
#include <span>

namespace pixelflex::testing {

/// Plays a server that says exactly these bytes, from its greeting on, whatever is answered. The client may do nothing
/// but end with a SessionError that has a message; anything else is a bug and leaves as another exception or an abort.
/// Returns how many whole updates came.
int hearServer(std::span<const std::uint8_t> bytes);

}  // namespace pixelflex::testing
