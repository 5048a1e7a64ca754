#pragma once

#include <functional>
#include <map>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace pixelflex::calib {

/// How a program ends that was called wrongly; 1 is for one that could not do its work.
constexpr int kWrongUsage = 2;

/// The main function of the program of an App that is named "pixelflex NAME": adds --version, parses, runs. `parse`
/// throws CLI::ParseError, as App::parse does, or std::invalid_argument when what was given is no use. Says what is
/// wrong as "pixelflex-NAME: …" on standard error. Returns the exit status.
[[nodiscard]] int runCommand(CLI::App& app, const std::function<void()>& parse, const std::function<int()>& run);

/// The option takes one of these words, and its variable, an enumeration, the word's meaning.
void takeOneOf(CLI::Option* option, const std::map<std::string, int>& words);
template <class Meaning>
void takeOneOf(CLI::Option* option, const std::map<std::string, Meaning>& words) {
  std::map<std::string, int> numbers;
  for (const auto& [word, meaning] : words) numbers.emplace(word, static_cast<int>(meaning));
  takeOneOf(option, numbers);
}

}  // namespace pixelflex::calib
