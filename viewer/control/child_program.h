#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

namespace pixelflex::viewer {

/// The folder of the program that is running, and of its siblings.
[[nodiscard]] std::filesystem::path programsFolder();

/// What a child reads.
enum class ChildInput {
  kNothing,
  kOurLife,  // nothing either, but that ends only when this process does, however it ends
};

/// Runs a program to its end in a process group of its own; `line` hears what it prints, line by line, `isError` for
/// its standard error. A stop request ends it (SIGTERM, and SIGKILL for one that does not listen). Returns its exit
/// status, 128 + N when signal N ended it. Throws std::system_error when it cannot be run.
int runChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const std::stop_token& stop, const std::function<void(const std::string& text, bool isError)>& line,
                    ChildInput input = ChildInput::kNothing);

}  // namespace pixelflex::viewer
