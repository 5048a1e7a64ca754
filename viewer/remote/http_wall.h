#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viewer/remote/http_message.h"
#include "viewer/remote/wall_remote.h"

namespace pixelflex::viewer {

struct HttpWallOptions {
  std::string name;   // of the wall
  std::string token;  // empty: none is needed
};

/// A wall's state and orders in HTTP and JSON. Long things answer 202 with their job, whose end GET /jobs/N tells.
///
/// GET / (a page), /state, /devices/NAME, /presets, /jobs/N, /log?after=N.
/// POST /power, /mute and /freeze {"on": …}, /devices/NAMES {"setting": value} or ["pan+=2", "home"],
/// /presets/NAME/restore {"verify", "dry_run"}, /calibrate {"steps", "all", "check", "only", "skip", "method"}, /halt.
/// PUT and DELETE /presets/NAME; DELETE /jobs/N cancels.
class HttpWall {
 public:
  /// `remote` must outlive it, and is only used from the thread that calls answer().
  HttpWall(WallRemote& remote, HttpWallOptions options) : remote_(remote), options_(std::move(options)) {}

  /// Never throws for what a request says.
  [[nodiscard]] HttpReply answer(const HttpRequest& request);

 private:
  using Words = std::vector<std::string>;
  [[nodiscard]] HttpReply read(const Words& path, const std::string& query) const;
  [[nodiscard]] HttpReply order(const HttpRequest& request, const Words& path);
  [[nodiscard]] HttpReply orderAll(const std::string& what, const std::string& body);
  [[nodiscard]] HttpReply changePreset(const std::string& method, const std::string& name, const std::string& body);
  [[nodiscard]] HttpReply restore(const std::string& name, const std::string& body);
  [[nodiscard]] HttpReply cancel(const std::string& job);
  [[nodiscard]] HttpReply state() const;
  [[nodiscard]] HttpReply started(int job) const;

  WallRemote& remote_;
  HttpWallOptions options_;
};

}  // namespace pixelflex::viewer
