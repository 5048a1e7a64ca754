#include "calib/programs/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

namespace pixelflex::calib {
namespace {

/// What has been printed comes before what is wrong, also where both go into one file.
int fail(const std::string& program, const std::string& what, int status) {
  std::cout.flush();
  std::fflush(stdout);
  std::cerr << program << ": " << what << '\n';
  return status;
}

}  // namespace

int runCommand(CLI::App& app, const std::function<void()>& parse, const std::function<int()>& run) {
  const std::string command = app.get_name();
  std::string program = command;
  std::ranges::replace(program, ' ', '-');
  app.set_version_flag("--version", program + " " PIXELFLEX_VERSION);
  try {
    parse();
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return fail(program, error.what() + ("; see " + command) + " --help", kWrongUsage);
  } catch (const std::invalid_argument& error) {
    return fail(program, error.what(), kWrongUsage);
  } catch (const std::exception& error) {
    return fail(program, error.what(), 1);
  }
  try {
    return run();
  } catch (const std::exception& error) {
    return fail(program, error.what(), 1);
  }
}

void takeOneOf(CLI::Option* option, const std::map<std::string, int>& words) {
  const auto turn = [words](std::string& text) {
    if (const auto found = words.find(text); found != words.end()) {
      text = std::to_string(found->second);
      return std::string();
    }
    std::string known;
    for (const auto& [word, number] : words) known += (known.empty() ? "" : ", ") + word;
    return "\"" + text + "\" is none of " + known;
  };
  option->transform(CLI::Validator(turn, ""));
}

}  // namespace pixelflex::calib
