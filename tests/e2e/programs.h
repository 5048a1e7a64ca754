#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace pixelflex::testing {

/// Runs build/bin/pixelflex-NAME to its end, standard output and error together.
[[nodiscard]] inline Output runProgram(const std::string& name, std::vector<std::string> arguments,
                                       std::chrono::seconds timeout = std::chrono::seconds(200)) {
  arguments.insert(arguments.begin(), std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-" + name);
  return run(arguments, {}, timeout);
}

[[nodiscard]] inline std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline void writeText(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// `text` with the first `from` replaced by `to`; the same text when it is not there.
[[nodiscard]] inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline const std::string kMiniRig = std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/mini-2.yaml";

}  // namespace pixelflex::testing
