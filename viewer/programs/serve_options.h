#pragma once

#include <string>
#include <vector>

#include "viewer/remote/remote_control.h"

namespace CLI {
class App;
}

namespace pixelflex::viewer {

/// The remote control of a wall on a command line, as typed.
struct ServeOptions {
  std::string http;
  std::string tokenFile;
  std::string pjlink;
  std::string pjlinkPasswordFile;
  std::vector<std::string> pjlinkListeners;
  std::string name;
  /// Something was asked for: without a word nobody listens.
  [[nodiscard]] bool isWanted() const { return !http.empty() || !pjlink.empty(); }
};

void defineServeOptions(CLI::App& app, ServeOptions& options);

/// Reads the files that are named. `wall` is its folder. Throws std::invalid_argument for options that make no sense,
/// std::runtime_error for files that cannot be used.
[[nodiscard]] RemoteControlOptions remoteControlOptions(const ServeOptions& options, const std::string& wall);

/// Where to find them, a line each.
[[nodiscard]] std::vector<std::string> placesOf(const RemoteControl& control);

}  // namespace pixelflex::viewer
