#include "viewer/remote/remote_control.h"

#include <stdexcept>

#include "devices/transport/line_loop.h"
#include "viewer/remote/http_server.h"
#include "viewer/remote/http_wall.h"
#include "viewer/remote/wall_remote.h"

namespace pixelflex::viewer {
namespace {

void requireSafety(const RemoteControlOptions& options) {
  if (!options.token.empty() && options.token.size() < kShortestToken) {
    throw std::invalid_argument("a token of less than " + std::to_string(kShortestToken) +
                                " characters can be guessed");
  }
  if (options.http && !options.http->isLoopback() && options.token.empty()) {
    throw std::invalid_argument("HTTP at " + options.http->text() +
                                " would let everybody on the network control the wall: a token is needed there");
  }
}

}  // namespace

/// In the order in which it may be taken down.
struct RemoteControl::Parts {
  Parts(WallConsole& console, const RemoteControlOptions& options) : remote(console) {
    if (options.http) {
      httpWall.emplace(remote, HttpWallOptions{.name = options.name, .token = options.token});
      http.emplace(loop, HttpServerOptions{.at = *options.http},
                   [this](const HttpRequest& request) { return httpWall->answer(request); });
    }
  }

  WallRemote remote;
  std::optional<HttpWall> httpWall;
  devices::LineLoop loop;
  std::optional<HttpServer> http;
};

RemoteControl::RemoteControl(WallConsole& console, const RemoteControlOptions& options) {
  requireSafety(options);
  parts_ = std::make_unique<Parts>(console, options);
}

RemoteControl::~RemoteControl() = default;

std::optional<ListenAddress> RemoteControl::http() const {
  return parts_->http ? std::optional(parts_->http->address()) : std::nullopt;
}

}  // namespace pixelflex::viewer
