#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace pixelflex::calib {

/// How a program ends that was called wrongly; 1 is for one that could not do its work.
constexpr int kWrongUsage = 2;

/// The main function of the program of an App that is named "pixelflex NAME": adds --version, parses, runs. `parse`
/// throws CLI::ParseError, as App::parse does, or std::invalid_argument when what was given is no use. Says what is
/// wrong as "pixelflex-NAME: …" on standard error. Returns the exit status.
[[nodiscard]] int runCommand(CLI::App& app, const std::function<void()>& parse, const std::function<int()>& run);

}  // namespace pixelflex::calib
