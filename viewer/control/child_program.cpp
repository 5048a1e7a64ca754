#include "viewer/control/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <optional>
#include <system_error>

#include "viewer/control/spawn_attributes.h"

namespace pixelflex::viewer {
namespace {

constexpr int kLookMs = 100;
constexpr std::chrono::seconds kPatience{10};

/// Ends when this process does.
class LifeLine {
 public:
  LifeLine() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  }
  ~LifeLine() {
    for (const int end : ends_) ::close(end);
  }
  LifeLine(const LifeLine&) = delete;
  LifeLine& operator=(const LifeLine&) = delete;
  [[nodiscard]] int readEnd() const { return ends_[0]; }

 private:
  std::array<int, 2> ends_{};
};

/// One of the child's output streams, cut into lines.
class LineStream {
 public:
  LineStream() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    readEnd_ = ends[0];
    writeEnd_ = ends[1];
  }
  ~LineStream() {
    closeWriteEnd();
    if (readEnd_ >= 0) ::close(readEnd_);
  }
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;

  [[nodiscard]] int readEnd() const { return readEnd_; }  // -1: at its end
  [[nodiscard]] int writeEnd() const { return writeEnd_; }
  void closeWriteEnd() {
    if (writeEnd_ >= 0) ::close(writeEnd_);
    writeEnd_ = -1;
  }

  void read(const std::function<void(const std::string& text)>& line) {
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(readEnd_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) return;
    if (count > 0) rest_.append(bytes.data(), static_cast<std::size_t>(count));
    for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
      line(rest_.substr(0, end));
      rest_.erase(0, end + 1);
    }
    if (count > 0) return;
    if (!rest_.empty()) line(rest_);
    rest_.clear();
    ::close(readEnd_);
    readEnd_ = -1;
  }

 private:
  int readEnd_ = -1;
  int writeEnd_ = -1;
  std::string rest_;
};

class SpawnFiles {
 public:
  SpawnFiles(const std::optional<LifeLine>& input, int output, int errors) {
    ::posix_spawn_file_actions_init(&actions_);
    if (input) {
      ::posix_spawn_file_actions_adddup2(&actions_, input->readEnd(), STDIN_FILENO);
    } else {
      ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
  }
  ~SpawnFiles() { ::posix_spawn_file_actions_destroy(&actions_); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

pid_t start(std::string program, std::vector<std::string> arguments, const std::optional<LifeLine>& input,
            const LineStream& output, const LineStream& errors) {
  std::vector<char*> all = {program.data()};
  for (auto& argument : arguments) all.push_back(argument.data());
  all.push_back(nullptr);
  const SpawnAttributes attributes;
  const SpawnFiles files(input, output.writeEnd(), errors.writeEnd());
  pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), files.get(), attributes.get(), all.data(), environ);
  if (error != 0) throw std::system_error(error, std::generic_category(), program);
  return child;
}

}  // namespace

std::filesystem::path programsFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

int runChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const std::stop_token& stop, const std::function<void(const std::string& text, bool isError)>& line,
                    ChildInput input) {
  std::optional<LifeLine> life;
  if (input == ChildInput::kOurLife) life.emplace();
  LineStream output;
  LineStream errors;
  const pid_t child = start(program, arguments, life, output, errors);
  output.closeWriteEnd();
  errors.closeWriteEnd();
  std::chrono::steady_clock::time_point asked{};
  while (output.readEnd() >= 0 || errors.readEnd() >= 0) {
    std::array<pollfd, 2> both = {pollfd{output.readEnd(), POLLIN, 0}, pollfd{errors.readEnd(), POLLIN, 0}};
    if (::poll(both.data(), both.size(), kLookMs) > 0) {
      if (both[0].revents != 0) output.read([&](const std::string& text) { line(text, false); });
      if (both[1].revents != 0) errors.read([&](const std::string& text) { line(text, true); });
    }
    if (!stop.stop_requested()) continue;
    const auto now = std::chrono::steady_clock::now();
    if (asked == decltype(asked){}) {
      asked = now;
      ::kill(-child, SIGTERM);
    } else if (now - asked > kPatience) {
      ::kill(-child, SIGKILL);
    }
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace pixelflex::viewer
