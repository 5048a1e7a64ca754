#pragma once

#include <string>

#include "viewer/programs/view_options.h"

namespace CLI {
class App;
}

namespace pixelflex::viewer {

/// What the command line of `pixelflex view` says in words, until take() has understood it.
struct ViewTexts {
  std::string server;
  int settle = 0;  // milliseconds
  std::string region;
  bool resize = false;
  std::string screens = "one";
  std::string primary = "on";
  std::string require;
  std::string stats;
};

/// All must outlive the parsing.
void defineOptions(CLI::App& app, ViewOptions& options, ViewTexts& texts);

/// After the parsing. Throws std::invalid_argument.
void take(const ViewTexts& texts, ViewOptions& options);

}  // namespace pixelflex::viewer
