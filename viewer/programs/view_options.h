#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "viewer/vnc/server_address.h"

namespace pixelflex::viewer {

/// The command line of `pixelflex view`.
struct ViewOptions {
  std::string wall;
  ServerAddress server;
  bool headless = false;
  std::optional<std::string> screenshot;  // folder
  std::chrono::milliseconds settle{500};
  std::vector<std::string> projectors;  // empty: all
  bool viewOnly = false;
  std::optional<std::string> passwordFile;
  bool stats = false;
  int depth = 8;  // bits for each colour of a projector's picture: 8 or 10
};

}  // namespace pixelflex::viewer
