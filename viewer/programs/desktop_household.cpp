#include "viewer/programs/desktop_household.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCannotRun = 127;
constexpr std::chrono::seconds kPatience{5};  // with a process that was told to end

sigset_t watchedSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&signals, signal);
  struct sigaction hangup {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
  return signals;
}

void redirect(const std::filesystem::path& log) {
  if (log.empty()) return;
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
}

[[noreturn]] void become(std::vector<std::string>& command, const ChildOptions& options, int report, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(kCannotRun);
  const sigset_t watched = watchedSignals();
  ::sigprocmask(SIG_UNBLOCK, &watched, nullptr);
  for (const auto& [name, value] : options.environment) {
    if (value.empty()) {
      ::unsetenv(name.c_str());
    } else {
      ::setenv(name.c_str(), value.c_str(), 1);
    }
  }
  redirect(options.log);
  if (options.inheritedFd >= 0) ::fcntl(options.inheritedFd, F_SETFD, 0);
  std::vector<char*> arguments;
  for (auto& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  const int error = errno;
  (void)!::write(report, &error, sizeof error);
  ::_exit(kCannotRun);
}

// The children of this process, adopted ones among them.
std::vector<pid_t> childrenNow() {
  std::ifstream list("/proc/self/task/" + std::to_string(::getpid()) + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; list >> child;) children.push_back(child);
  return children;
}

}  // namespace

Household::Household() {
  const sigset_t watched = watchedSignals();
  ::sigprocmask(SIG_BLOCK, &watched, nullptr);
  signals_ = ::signalfd(-1, &watched, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
  // Whoever is left without a parent below this process becomes its child.
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
}

Household::~Household() {
  endTheRest();
  ::close(signals_);
}

pid_t Household::start(std::vector<std::string> command, const ChildOptions& options) {
  std::array<int, 2> report{};
  if (::pipe2(report.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(command, options, report[1], parent);
  ::close(report[1]);
  int error = child < 0 ? errno : 0;
  const bool failed = child < 0 || ::read(report[0], &error, sizeof error) > 0;
  ::close(report[0]);
  if (failed) throw std::runtime_error("cannot run " + command.front() + ": " + std::generic_category().message(error));
  ::setpgid(child, child);  // there already, unless the child has ended
  return child;
}

Household::Event Household::wait(std::optional<std::chrono::milliseconds> timeout, int readable) {
  const auto unreported = [this]() -> std::optional<pid_t> {
    for (const auto& [child, status] : statuses_) {
      if (std::ranges::find(reported_, child) == reported_.end()) return child;
    }
    return std::nullopt;
  };
  std::array<pollfd, 2> watched{{{signals_, POLLIN, 0}, {readable, POLLIN, 0}}};
  if (!unreported()) ::poll(watched.data(), watched.size(), timeout ? static_cast<int>(timeout->count()) : -1);
  Event event;
  signalfd_siginfo signal{};
  while (::read(signals_, &signal, sizeof signal) == sizeof signal) event.quit |= signal.ssi_signo != SIGCHLD;
  reap();
  event.ended = unreported();
  if (event.ended) reported_.push_back(*event.ended);
  return event;
}

void Household::reap() {
  int status = 0;
  for (pid_t child = 0; (child = ::waitpid(-1, &status, WNOHANG)) > 0;) {
    statuses_[child] = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
}

std::optional<int> Household::statusOf(pid_t child) const {
  const auto found = statuses_.find(child);
  return found == statuses_.end() ? std::nullopt : std::optional(found->second);
}

void Household::end(pid_t child) {
  reap();
  ::kill(-child, SIGTERM);  // members may be there after it has ended itself
  const auto deadline = Clock::now() + kPatience;
  while (!statusOf(child) && Clock::now() < deadline) (void)wait(std::chrono::milliseconds(100));
  if (!statusOf(child)) ::kill(-child, SIGKILL);
  while (!statusOf(child)) (void)wait(std::chrono::milliseconds(100));
}

void Household::endTheRest() {
  const auto deadline = Clock::now() + kPatience;
  reap();
  for (auto rest = childrenNow(); !rest.empty(); rest = childrenNow()) {
    for (const pid_t child : rest) ::kill(child, Clock::now() < deadline ? SIGTERM : SIGKILL);
    (void)wait(std::chrono::milliseconds(100));
  }
}

}  // namespace pixelflex::viewer
