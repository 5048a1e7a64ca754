#pragma once

#include <memory>
#include <optional>
#include <string>

#include "viewer/remote/listen_address.h"

namespace pixelflex::viewer {

class WallConsole;

struct RemoteControlOptions {
  std::string name = {};                   // of the wall, for those who ask
  std::optional<ListenAddress> http = {};  // none: no HTTP
  std::string token = {};                  // for HTTP; empty: none is needed
};

/// The remote controls of a wall, on a thread of their own.
class RemoteControl {
 public:
  /// `console` must outlive it. Throws std::invalid_argument for what would leave the wall open to the network,
  /// std::runtime_error when nothing can listen there.
  RemoteControl(WallConsole& console, const RemoteControlOptions& options);
  ~RemoteControl();
  RemoteControl(const RemoteControl&) = delete;
  RemoteControl& operator=(const RemoteControl&) = delete;

  /// With the port that a 0 became; nothing without HTTP.
  [[nodiscard]] std::optional<ListenAddress> http() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Tokens shorter than this could be guessed.
inline constexpr std::size_t kShortestToken = 32;

}  // namespace pixelflex::viewer
