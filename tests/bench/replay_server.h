#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "tests/bench/rfb_recording.h"
#include "tests/bench/unix_socket.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// A VNC server at a UNIX socket that says what another one said, as fast as its one viewer takes it.
class ReplayServer {
 public:
  explicit ReplayServer(const RfbRecording& recording);

  [[nodiscard]] const std::string& socketPath() const { return path_; }
  /// Waits for the viewer and shakes hands. Throws std::runtime_error.
  void accept();
  /// Sends the whole recording once. The time from its first byte to the answer to the fence behind its last one: by
  /// then the viewer has decoded everything. Every pass begins with zlib streams of its own, so it may be repeated.
  [[nodiscard]] std::chrono::nanoseconds play();

 private:
  void send(const std::vector<std::uint8_t>& bytes);
  /// Whether a whole message of the viewer was there; it is forgotten, but an answer to a fence is noted.
  bool takeMessage();
  void takeMessages();

  const RfbRecording& recording_;
  TemporaryFolder folder_;
  std::string path_;
  UnixSocket listener_;
  std::optional<UnixSocket> viewer_;
  std::vector<std::uint8_t> said_;  // by the viewer, not understood yet
  int answers_ = 0;                 // to fences
};

}  // namespace pixelflex::testing
