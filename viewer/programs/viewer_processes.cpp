#include "viewer/programs/viewer_processes.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "viewer/programs/quit_signal.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {
namespace {

using std::chrono::milliseconds;

constexpr int kPasswordStatus = 77;  // of a viewer that needs one
// One that runs for so long has a display.
constexpr std::chrono::seconds kGood{3};

milliseconds waitAfter(int failures) {
  return std::min(milliseconds(250) * (1 << std::min(failures, 10)), milliseconds(10'000));
}

timespec timespecOf(std::chrono::nanoseconds time) {
  const auto left = std::max(time, std::chrono::nanoseconds::zero());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
  return {.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
}

}  // namespace

ViewerProcesses::ViewerProcesses(View view) : view_(std::move(view)), watched_(quitSignals()) {
  std::signal(SIGCHLD, SIG_DFL);  // children of a process that ignores it cannot be waited for
  sigaddset(&watched_, SIGCHLD);
  pthread_sigmask(SIG_BLOCK, &watched_, &before_);
}

ViewerProcesses::~ViewerProcesses() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void ViewerProcesses::add(std::string display, ViewOptions options) {
  Viewer viewer{.display = std::move(display), .options = std::move(options)};
  viewer.due = Clock::now();
  viewers_.push_back(std::move(viewer));
}

int ViewerProcesses::run() {
  startDue();
  while (anyRuns()) {
    waitForSignal();
    reap();
    if (anyRuns()) startDue();
    greetReturned();
  }
  if (passwordNeeded_) throw PasswordNeeded("the server asks for a password");
  return left_ ? 0 : worst_;
}

void ViewerProcesses::start(Viewer& viewer) {
  viewer.due.reset();
  viewer.begun = Clock::now();
  const pid_t parent = ::getpid();
  std::fflush(nullptr);  // or the new process would write it, too
  viewer.process = ::fork();
  if (viewer.process == 0) become(viewer, parent);
  if (viewer.process < 0) throw ViewError("cannot start a viewer for display " + viewer.display);
}

void ViewerProcesses::become(const Viewer& viewer, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  int status = 1;
  try {
    ::setenv("DISPLAY", viewer.display.c_str(), 1);
    if (::getppid() == parent) status = view_(viewer.options);
  } catch (const PasswordNeeded&) {
    status = kPasswordStatus;
  } catch (const std::exception& error) {
    // What is tried again and again need not be said again and again.
    if (viewer.failures == 0) fmt::print(stderr, "pixelflex-view: on display {}: {}\n", viewer.display, error.what());
  }
  std::fflush(nullptr);
  ::_exit(status);
}

bool ViewerProcesses::anyRuns() const {
  return std::ranges::any_of(viewers_, [](const Viewer& viewer) { return viewer.process > 0; });
}

std::optional<ViewerProcesses::Clock::time_point> ViewerProcesses::nextDue() const {
  std::optional<Clock::time_point> next;
  for (const Viewer& viewer : viewers_) {
    const bool unsure = viewer.process > 0 && viewer.failures > 0;
    const auto due = unsure ? std::optional(viewer.begun + kGood) : viewer.due;
    if (due && (!next || *due < *next)) next = due;
  }
  return next;
}

void ViewerProcesses::waitForSignal() {
  const auto due = nextDue();
  const timespec time = timespecOf(due.value_or(Clock::now()) - Clock::now());
  const int signal = ::sigtimedwait(&watched_, nullptr, due ? &time : nullptr);
  if (signal > 0 && signal != SIGCHLD) endAll();
}

void ViewerProcesses::startDue() {
  for (Viewer& viewer : viewers_) {
    if (viewer.due && *viewer.due <= Clock::now()) start(viewer);
  }
}

void ViewerProcesses::greetReturned() {
  for (Viewer& viewer : viewers_) {
    if (viewer.process < 0 || viewer.failures == 0 || Clock::now() < viewer.begun + kGood) continue;
    viewer.failures = 0;
    fmt::print(stderr, "pixelflex-view: display {} is shown again\n", viewer.display);
  }
}

void ViewerProcesses::reap() {
  for (Viewer& viewer : viewers_) {
    int status = 0;
    if (viewer.process < 0 || ::waitpid(viewer.process, &status, WNOHANG) != viewer.process) continue;
    viewer.process = -1;
    ended(viewer, WIFEXITED(status) ? WEXITSTATUS(status) : 1);
  }
}

void ViewerProcesses::ended(Viewer& viewer, int status) {
  passwordNeeded_ = passwordNeeded_ || status == kPasswordStatus;
  const bool writes = viewer.options.screenshot.has_value();  // each its own
  left_ = left_ || (status == 0 && !writes);
  worst_ = std::max(worst_, status);
  if (passwordNeeded_ || left_) return endAll();
  if (status != 0 && !ending_) fail(viewer);
}

void ViewerProcesses::fail(Viewer& viewer) {
  if (!anyRuns()) return;
  const bool again = !viewer.options.screenshot && viewer.options.retry != Retry::kNever;
  if (viewer.failures == 0) {
    fmt::print(stderr, "pixelflex-view: display {} is dark, the others go on{}\n", viewer.display,
               again ? "; it is tried again until it is back" : "");
  }
  if (!again) return;
  // A server that is away at that moment is no reason to fail once more.
  viewer.options.retry = Retry::kAlways;
  viewer.due = Clock::now() + waitAfter(++viewer.failures);
}

void ViewerProcesses::endAll() {
  ending_ = true;
  for (Viewer& viewer : viewers_) {
    viewer.due.reset();
    if (viewer.process > 0) ::kill(viewer.process, SIGTERM);
  }
}

}  // namespace pixelflex::viewer
