// pixelflex NAME …: runs the program pixelflex-NAME beside this one, as git does. Each does its own work with its own
// libraries, so that a render node carries no OpenCV.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/spelling.h"

namespace {

constexpr int kWrongUsage = 2;

struct Command {
  std::string_view name;
  std::string_view description;
};

constexpr std::array kCommands = {
    Command{"new", "makes a wall's folder with a commented wall.yaml"},
    Command{"check", "lists everything wrong with the files of a wall"},
    Command{"calibrate", "measures where each projector's light falls and how bright it is"},
    Command{"camera", "lists the cameras there are, and takes a photograph with one"},
    Command{"view", "shows a VNC desktop on the wall"},
    Command{"desktop", "runs an X desktop of the wall's own size on the wall"},
    Command{"simulate", "composes projector frames into what the audience of a simulated wall sees"},
    Command{"model", "shows a 3D model on the wall"},
    Command{"panel", "opens the control panel"},
    Command{"preset", "saves and restores device settings with their calibration"},
    Command{"device", "lists, reads or sets the settings of devices"},
    Command{"serve", "lets programs, telephones and room controllers control the wall"},
};

std::filesystem::path ownFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::filesystem::path programOf(std::string_view command) {
  return ownFolder() / ("pixelflex-" + std::string(command));
}

bool isPresent(std::string_view command) {
  return ::access(programOf(command).c_str(), X_OK) == 0;
}

bool isCommandName(std::string_view name) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  return !name.empty() && name.front() != '-' && std::ranges::all_of(name, isLetter);
}

void printHelp(std::ostream& stream) {
  constexpr std::size_t kColumn = 11;
  stream << "Usage: pixelflex COMMAND [ARGUMENTS]\n       pixelflex help COMMAND\n       pixelflex "
            "--version\n\nCommands:\n";
  for (const auto& [name, description] : kCommands) {
    if (isPresent(name)) stream << "  " << name << std::string(kColumn - name.size(), ' ') << description << '\n';
  }
}

/// The present command nearest to a mistyped one; empty when none is near.
std::string nearestCommand(std::string_view typed) {
  std::set<std::string> present;
  for (const auto& [name, description] : kCommands) {
    if (isPresent(name)) present.emplace(name);
  }
  return pixelflex::calib::nearestWord(typed, present);
}

int refuse(const std::string& name) {
  std::cerr << "pixelflex: there is no command \"" << name << "\"";
  if (const auto suggestion = nearestCommand(name); !suggestion.empty()) {
    std::cerr << "; did you mean \"" << suggestion << "\"?";
  }
  std::cerr << " (pixelflex help lists the commands)\n";
  return kWrongUsage;
}

/// Replaces this process; returns only when that is not possible.
int run(const std::string& name, std::vector<std::string> arguments) {
  if (!isCommandName(name) || !isPresent(name)) return refuse(name);
  std::string program = programOf(name).string();
  std::vector<char*> pointers = {program.data()};
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  std::cerr << "pixelflex: cannot run " << program << ": " << std::strerror(errno) << '\n';
  return 1;
}

int dispatch(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    printHelp(std::cerr);
    return kWrongUsage;
  }
  const std::string& first = arguments.front();
  if (first == "--version") {
    std::cout << "pixelflex " << PIXELFLEX_VERSION << '\n';
    return 0;
  }
  if (first == "help" || first == "--help" || first == "-h") {
    if (first == "help" && arguments.size() > 1) return run(arguments[1], {"--help"});
    printHelp(std::cout);
    return 0;
  }
  return run(first, {arguments.begin() + 1, arguments.end()});
}

}  // namespace

int main(int argc, char** argv) try {
  return dispatch({argv + std::min(argc, 1), argv + argc});
} catch (const std::exception& error) {
  std::cerr << "pixelflex: " << error.what() << '\n';
  return 1;
}
