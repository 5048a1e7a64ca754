#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "viewer/vnc/input_queue.h"

namespace pixelflex::viewer {

/// Which keys and buttons are down, here and on the server, so that none stays down on the desktop when the connection
/// breaks, and none goes down there that was pressed while there was no connection: a key that repeats or a button that
/// drags begins anew only when it is let go and pressed again. Not thread-safe.
class HeldInput {
 public:
  /// Input while connected: false when it must not be sent. May take buttons out of it.
  [[nodiscard]] bool admit(Input& input);
  /// Input while there is no connection; none of it is ever sent.
  void ignore(const Input& input);
  /// The connection broke.
  void lose();
  /// What a new connection begins with: everything that was down on the old one goes up, the pointer to where it was.
  [[nodiscard]] std::vector<Input> takeReleases();

 private:
  std::set<std::uint32_t> down_;    // as this connection's server knows it
  std::set<std::uint32_t> stale_;   // down here, but not to be seen by the server
  std::set<std::uint32_t> broken_;  // was down on a connection that broke
  std::uint16_t staleButtons_ = 0;
  bool pointed_ = false;
  PointerInput pointer_;  // the last one sent
};

}  // namespace pixelflex::viewer
