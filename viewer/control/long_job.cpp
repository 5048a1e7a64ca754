#include "viewer/control/long_job.h"

#include <exception>
#include <stdexcept>
#include <utility>

namespace pixelflex::viewer {

void JobView::tell(const std::string& state, std::optional<double> part) const {
  board.changeJob(number, [&](ConsoleJob& job) {
    job.state = state;
    job.part = part;
  });
}

void JobView::say(const std::string& line) const {
  board.changeJob(number, [&](ConsoleJob& job) { job.said.push_back(line); });
}

LongJob::~LongJob() {
  std::jthread last;
  {
    const std::lock_guard lock(mutex_);
    last = std::move(thread_);
  }
  last.request_stop();
}

int LongJob::start(ConsoleJob::Kind kind, const std::string& command, std::function<void(const JobView& view)> action) {
  const std::lock_guard lock(mutex_);
  if (running_) throw std::runtime_error("\"" + command_ + "\" is still running: wait for it, or cancel it first");
  if (thread_.joinable()) thread_.join();
  running_ = true;
  kind_ = kind;
  command_ = command;
  number_ = board_.beginJob(kind, command);
  thread_ = std::jthread([this, number = number_, action = std::move(action)](const std::stop_token& stop) {
    std::string error;
    try {
      action({board_, number, stop});
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    {
      const std::lock_guard running(mutex_);
      running_ = false;
    }
    board_.endJob(number, error);
  });
  return number_;
}

void LongJob::cancel(int job) {
  const std::lock_guard lock(mutex_);
  if (running_ && number_ == job) thread_.request_stop();
}

void LongJob::cancel(ConsoleJob::Kind kind) {
  const std::lock_guard lock(mutex_);
  if (running_ && kind_ == kind) thread_.request_stop();
}

}  // namespace pixelflex::viewer
