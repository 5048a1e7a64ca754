#include "viewer/programs/serve_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "viewer/programs/private_file.h"

namespace pixelflex::viewer {
namespace {

/// What a header can carry.
std::string tokenIn(const std::string& file) {
  const std::string token(readPrivateLine(file, "token").text());
  const auto fits = [](char c) { return c > ' ' && c <= '~'; };
  if (token.size() < kShortestToken || !std::ranges::all_of(token, fits)) {
    throw std::runtime_error(file + ": a token is " + std::to_string(kShortestToken) +
                             " or more letters, digits and signs without a blank; openssl rand -hex 32 makes one");
  }
  return token;
}

/// Of the folder, whatever way it was named.
std::string nameOf(const std::string& wall) {
  const auto path = std::filesystem::weakly_canonical(wall);
  return path.filename().empty() ? "wall" : path.filename().string();
}

}  // namespace

void defineServeOptions(CLI::App& app, ServeOptions& options) {
  app.add_option("--http", options.http, "HTTP and JSON, and a page for telephones, at [ADDRESS:]PORT");
  app.add_option("--token-file", options.tokenFile,
                 "Every request must carry this file's first line (Authorization: Bearer TOKEN)");
  app.add_option("--name", options.name, "What the wall calls itself; without it, its folder's name");
}

RemoteControlOptions remoteControlOptions(const ServeOptions& options, const std::string& wall) {
  RemoteControlOptions control;
  control.name = options.name.empty() ? nameOf(wall) : options.name;
  if (!options.http.empty()) control.http = parseListenAddress(options.http);
  if (!options.tokenFile.empty()) control.token = tokenIn(options.tokenFile);
  if (control.http && !control.http->isLoopback() && control.token.empty()) {
    throw std::invalid_argument("--http " + options.http + " is reached from the network: give --token-file, too");
  }
  return control;
}

std::vector<std::string> placesOf(const RemoteControl& control) {
  std::vector<std::string> places;
  if (const auto http = control.http()) places.push_back("http://" + http->text() + "/");
  return places;
}

}  // namespace pixelflex::viewer
