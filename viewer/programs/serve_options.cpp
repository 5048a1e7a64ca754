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

/// "10.0.0.7", "10.0.0.7:4352"
ListenAddress listenerAt(const std::string& text) {
  const bool hasPort = text.find(':') != std::string::npos;
  return parseListenAddress(hasPort ? text : text + ":" + std::to_string(kPjlinkPort));
}

}  // namespace

void defineServeOptions(CLI::App& app, ServeOptions& options) {
  app.add_option("--http", options.http, "HTTP and JSON, and a page for telephones, at [ADDRESS:]PORT");
  app.add_option("--token-file", options.tokenFile,
                 "Every request must carry this file's first line (Authorization: Bearer TOKEN)");
  app.add_option("--pjlink", options.pjlink, "The whole wall as one PJLink device of class 2, at [ADDRESS:]PORT");
  app.add_option("--pjlink-password-file", options.pjlinkPasswordFile, "Its password is this file's first line");
  app.add_option("--pjlink-notify", options.pjlinkListeners,
                 "Tell these controllers of changes (UDP): ADDRESS or ADDRESS:PORT")
      ->delimiter(',');
  app.add_option("--name", options.name, "What the wall calls itself; without it, its folder's name");
}

RemoteControlOptions remoteControlOptions(const ServeOptions& options, const std::string& wall) {
  RemoteControlOptions control;
  control.name = options.name.empty() ? nameOf(wall) : options.name;
  control.version = PIXELFLEX_VERSION;
  if (!options.http.empty()) control.http = parseListenAddress(options.http);
  if (!options.tokenFile.empty()) control.token = tokenIn(options.tokenFile);
  if (!options.pjlink.empty()) control.pjlink = parseListenAddress(options.pjlink);
  if (!options.pjlinkPasswordFile.empty()) {
    control.pjlinkPassword = readPrivateLine(options.pjlinkPasswordFile, "password").text();
  }
  for (const auto& each : options.pjlinkListeners) control.pjlinkListeners.push_back(listenerAt(each));
  if (control.http && !control.http->isLoopback() && control.token.empty()) {
    throw std::invalid_argument("--http " + options.http + " is reached from the network: give --token-file, too");
  }
  if (control.pjlink && !control.pjlink->isLoopback() && control.pjlinkPassword.empty()) {
    throw std::invalid_argument("--pjlink " + options.pjlink +
                                " is reached from the network: give --pjlink-password-file, too");
  }
  return control;
}

std::vector<std::string> placesOf(const RemoteControl& control) {
  std::vector<std::string> places;
  if (const auto http = control.http()) places.push_back("http://" + http->text() + "/");
  if (const auto pjlink = control.pjlink()) places.push_back("pjlink " + pjlink->text());
  return places;
}

}  // namespace pixelflex::viewer
