#include "viewer/model/scene_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>

#include "viewer/model/scene_import.h"
#include "viewer/model/scene_stream.h"

namespace pixelflex::viewer {
namespace {

std::uintmax_t memoryInUse() {
  std::ifstream statm("/proc/self/statm");
  std::uintmax_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::uintmax_t>(::sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) resource, std::uintmax_t most) {
  const rlimit value{static_cast<rlim_t>(most), static_cast<rlim_t>(most)};
  ::setrlimit(resource, &value);
}

/// Generous to any honest file: a text grows to about ten times its size in memory.
void limitReader(std::uintmax_t fileBytes) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, memoryInUse() + (std::uintmax_t{4} << 30) + 40 * fileBytes);
  limit(RLIMIT_CPU, 60 + fileBytes / 500'000);
}

/// The child's whole life.
[[noreturn]] void readInChild(const std::filesystem::path& file, int descriptor) {
  // What a crashing reader says on its way is of no use to anybody.
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  int status = 0;
  try {
    checkModelFile(file);
    limitReader(std::filesystem::file_size(file));
    sendScene(descriptor, importScene(file));
  } catch (const SenderGone&) {
    status = 1;
  } catch (const std::bad_alloc&) {
    sendFailure(descriptor, file.string() + ": asks for more memory than a file of its size can need; it is damaged");
  } catch (const std::exception& error) {
    sendFailure(descriptor, error.what());
  }
  ::_exit(status);
}

struct Pipe {
  Pipe() {
    if (::pipe2(ends, O_CLOEXEC) != 0) throw ModelError(std::string("cannot read models: ") + std::strerror(errno));
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close(int end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
  int ends[2] = {-1, -1};
};

int statusOf(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

std::string endOf(int status) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return "takes longer to read than a file of its size can need";
  }
  return "cannot be read: its reader broke down over it";
}

Scene loadOne(const std::filesystem::path& file) {
  Pipe pipe;
  const pid_t child = ::fork();
  if (child < 0) throw ModelError(file.string() + ": cannot start its reader: " + std::strerror(errno));
  if (child == 0) {
    pipe.close(0);
    readInChild(file, pipe.ends[1]);
  }
  pipe.close(1);
  std::optional<Scene> scene;
  try {
    scene = receiveScene(pipe.ends[0]);
  } catch (const SenderGone&) {
    throw ModelError(file.string() + ": " + endOf(statusOf(child)) + "; it is damaged: make it again");
  } catch (...) {
    statusOf(child);
    throw;
  }
  statusOf(child);
  return std::move(*scene);
}

}  // namespace

Scene loadScene(std::span<const std::filesystem::path> files) {
  Scene all;
  for (const auto& file : files) all.append(loadOne(file));
  return all;
}

}  // namespace pixelflex::viewer
