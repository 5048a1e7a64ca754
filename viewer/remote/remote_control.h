#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/remote/listen_address.h"

namespace pixelflex::viewer {

class WallConsole;

/// Tokens shorter than this could be guessed.
inline constexpr std::size_t kShortestToken = 32;

/// Where PJLink is spoken, by TCP and UDP.
inline constexpr int kPjlinkPort = 4352;

struct RemoteControlOptions {
  std::string name = {};                               // of the wall, for those who ask
  std::string version = {};                            // of the program
  std::optional<ListenAddress> http = {};              // none: no HTTP
  std::string token = {};                              // for HTTP; empty: none is needed
  std::optional<ListenAddress> pjlink = {};            // none: no PJLink
  std::string pjlinkPassword = {};                     // empty: none is needed
  std::vector<ListenAddress> pjlinkListeners = {};     // who hears of changes
  std::chrono::milliseconds pjlinkSearchLatest{3000};  // searches are answered at a random time before
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

  // With the port that a 0 became; nothing for what is not spoken.
  [[nodiscard]] std::optional<ListenAddress> http() const;
  [[nodiscard]] std::optional<ListenAddress> pjlink() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pixelflex::viewer
