#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"
#include "viewer/x11/local_session.h"

namespace pixelflex::testing {

[[nodiscard]] inline DesktopMirror::Make makeLocal(const viewer::LocalSessionOptions& options) {
  return [options](viewer::FrameBelt& belt, std::function<void()> wake) {
    return std::make_unique<viewer::LocalSession>(options, belt, std::move(wake));
  };
}

/// A local session's desktop in memory.
[[nodiscard]] inline std::unique_ptr<DesktopMirror> mirrorOf(const std::string& display) {
  return std::make_unique<DesktopMirror>(
      makeLocal({.display = viewer::parseXDisplay(display), .clipboardLimit = std::size_t{4} << 20}));
}

/// Xvfb with depth 24, at a display number of its own choice unless one is given in `more`.
[[nodiscard]] inline std::unique_ptr<XServer> startXvfb(devices::Size size, std::vector<std::string> more = {}) {
  return std::make_unique<XServer>([&](const TemporaryFolder&) {
    std::vector<std::string> command{
        "Xvfb",      "-screen", "0",       std::to_string(size.width) + "x" + std::to_string(size.height) + "x24",
        "-nolisten", "tcp",     "-noreset"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  });
}

}  // namespace pixelflex::testing
