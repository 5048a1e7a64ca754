#include "viewer/panel/open_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "viewer/control/spawn_attributes.h"

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
  const SpawnAttributes attributes;
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, attributes.get(), arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return console.log(LogLine::Kind::kError, "xdg-open cannot be run: open " + path + " in a browser");
  }
  // The one that forks ends at once.
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
}

}  // namespace pixelflex::viewer
