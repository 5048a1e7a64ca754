#pragma once

namespace pixelflex::testing {

/// A TCP port of 127.0.0.1 at which nothing listens now, outside of the range that the kernel hands to whoever
/// connects. Somebody else may take it at any moment: whoever uses one to listen must be ready to try again. Throws
/// std::runtime_error if none is found.
[[nodiscard]] int freePort();

}  // namespace pixelflex::testing
