#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

constexpr int kCannotStart = 127;

// Prepared before fork(): the child of a program with threads must not allocate.
std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::vector<std::string>& additions) {
  std::vector<std::string> all = additions;  // the first of a name counts
  for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
  return all;
}

[[noreturn]] void becomeChild(char* const* arguments, char* const* environment, const char* log, int inheritedFd,
                              pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int input = ::open("/dev/null", O_RDONLY);
  const int output = ::open(log, O_WRONLY | O_CREAT | O_APPEND, 0600);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  if (inheritedFd >= 0) ::fcntl(inheritedFd, F_SETFD, 0);
  ::execvpe(arguments[0], arguments, environment);
  ::_exit(kCannotStart);
}

int exitStatus(int waited) {
  return WIFEXITED(waited) ? WEXITSTATUS(waited) : 128 + WTERMSIG(waited);
}

}  // namespace

Process::Process(const std::vector<std::string>& command, const ProcessOptions& options) {
  std::vector<std::string> arguments = command;
  std::vector<std::string> environment = environmentWith(options.environment);
  const std::vector<char*> argumentPointers = pointersTo(arguments);
  const std::vector<char*> environmentPointers = pointersTo(environment);
  const std::string log = options.log.empty() ? "/dev/null" : options.log.string();
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork: " + std::string(std::strerror(errno)));
  if (pid_ == 0) {
    becomeChild(argumentPointers.data(), environmentPointers.data(), log.c_str(), options.inheritedFd, parent);
  }
  ::setpgid(pid_, pid_);  // also here, so that the group exists when the constructor returns
}

Process::~Process() {
  signal(SIGTERM);  // lets an X server take its lock file and socket along
  const bool ended = wait(std::chrono::seconds(2)).has_value();
  signal(SIGKILL);
  if (!ended) ::waitpid(pid_, nullptr, 0);
}

std::optional<int> Process::wait(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!status_) {
    int waited = 0;
    if (::waitpid(pid_, &waited, WNOHANG) == pid_) {
      status_ = exitStatus(waited);
    } else if (std::chrono::steady_clock::now() >= deadline) {
      return std::nullopt;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  return status_;
}

void Process::signal(int number) const {
  ::kill(-pid_, number);
}

Output run(const std::vector<std::string>& command, const std::vector<std::string>& environment,
           std::chrono::milliseconds timeout) {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder / "output";
  Process process(command, {environment, log, -1});
  const std::optional<int> status = process.wait(timeout);
  std::ifstream stream(log, std::ios::binary);
  Output output{status.value_or(-1), {std::istreambuf_iterator<char>(stream), {}}};
  if (!status) throw std::runtime_error(command.front() + " did not end in time; it said: " + output.text);
  return output;
}

}  // namespace pixelflex::testing
