#include "viewer/remote/remote_control.h"

#include <stdexcept>

#include "devices/transport/line_loop.h"
#include "viewer/remote/http_server.h"
#include "viewer/remote/http_wall.h"
#include "viewer/remote/pjlink_notices.h"
#include "viewer/remote/pjlink_server.h"
#include "viewer/remote/pjlink_wall.h"
#include "viewer/remote/wall_remote.h"

namespace pixelflex::viewer {
namespace {

// A free TCP port may be one of which the UDP port is taken.
constexpr int kAttempts = 20;

void requireSafety(const RemoteControlOptions& options) {
  if (!options.token.empty() && options.token.size() < kShortestToken) {
    throw std::invalid_argument("a token of less than " + std::to_string(kShortestToken) +
                                " characters can be guessed");
  }
  const auto require = [](const std::optional<ListenAddress>& at, const std::string& secret, const std::string& what) {
    if (!at || at->isLoopback() || !secret.empty()) return;
    throw std::invalid_argument(at->text() + " is reached from the network, where everybody could control the wall: " +
                                what + " is needed there");
  };
  require(options.http, options.token, "for HTTP a token");
  require(options.pjlink, options.pjlinkPassword, "for PJLink a password");
}

}  // namespace

/// In the order in which it may be taken down.
struct RemoteControl::Parts {
  Parts(WallConsole& console, const RemoteControlOptions& options) : remote(console) {
    if (options.http) serveHttp(options);
    for (int attempt = 1; options.pjlink && !notices; ++attempt) {
      try {
        servePjlink(options);
      } catch (const std::runtime_error&) {
        if (options.pjlink->port != 0 || attempt == kAttempts) throw;
      }
    }
  }

  void serveHttp(const RemoteControlOptions& options) {
    httpWall.emplace(remote, HttpWallOptions{.name = options.name, .token = options.token});
    http.emplace(loop, HttpServerOptions{.at = *options.http},
                 [this](const HttpRequest& request) { return httpWall->answer(request); });
  }

  void servePjlink(const RemoteControlOptions& options) {
    const std::string hardware = hardwareAddress();
    pjlink.reset();  // of the attempt before: it asks the wall
    pjlinkWall.emplace(remote, PjlinkIdentity{.name = options.name, .serial = hardware, .version = options.version});
    pjlink.emplace(loop, PjlinkServerOptions{.at = *options.pjlink, .password = options.pjlinkPassword},
                   [this](char itsClass, std::string_view body, std::string_view value) {
                     return pjlinkWall->answer(itsClass, body, value);
                   });
    notices.emplace(loop,
                    PjlinkNoticesOptions{.at = pjlink->address(),
                                         .listeners = options.pjlinkListeners,
                                         .hardware = hardware,
                                         .latest = options.pjlinkSearchLatest},
                    [this](std::string_view body) { return pjlinkWall->answer('1', body, "?"); });
  }

  WallRemote remote;
  std::optional<HttpWall> httpWall;
  std::optional<PjlinkWall> pjlinkWall;
  devices::LineLoop loop;
  std::optional<HttpServer> http;
  std::optional<PjlinkServer> pjlink;
  std::optional<PjlinkNotices> notices;
};

RemoteControl::RemoteControl(WallConsole& console, const RemoteControlOptions& options) {
  requireSafety(options);
  parts_ = std::make_unique<Parts>(console, options);
}

RemoteControl::~RemoteControl() = default;

std::optional<ListenAddress> RemoteControl::http() const {
  return parts_->http ? std::optional(parts_->http->address()) : std::nullopt;
}

std::optional<ListenAddress> RemoteControl::pjlink() const {
  return parts_->pjlink ? std::optional(parts_->pjlink->address()) : std::nullopt;
}

}  // namespace pixelflex::viewer
