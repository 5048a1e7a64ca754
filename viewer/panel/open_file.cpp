#include "viewer/panel/open_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <string>

namespace pixelflex::viewer {

void openFile(WallConsole& console, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    return console.log(LogLine::Kind::kError, file.string() + ": there is none yet; a calibration writes it");
  }
  console.log(LogLine::Kind::kCommand, "xdg-open " + file.string());
  std::string program = "setsid";
  std::string fork = "--fork";
  std::string opener = "xdg-open";
  std::string path = file.string();
  const std::array<char*, 5> arguments = {program.data(), fork.data(), opener.data(), path.data(), nullptr};
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  }
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) console.log(LogLine::Kind::kError, "xdg-open cannot be run: open " + path + " in a browser");
}

}  // namespace pixelflex::viewer
