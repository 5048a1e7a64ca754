#include "viewer/control/device_worker.h"

#include <exception>
#include <utility>

#include "devices/control/device_error.h"
#include "devices/transport/line_error.h"
#include "viewer/control/console_board.h"
#include "viewer/control/device_run.h"

namespace pixelflex::viewer {
namespace {

// Between two looks at a device that does not answer: its line has a patience of its own on top.
constexpr std::chrono::seconds kLostPause{2};
const std::string kStopped = "stopped on request";
// A device that does not answer would gather them without end, and do them all when it is back.
constexpr std::size_t kMostWaiting = 100;

}  // namespace

struct DeviceWorker::Reading {
  std::string identity;
  std::vector<std::string> actions;
  std::vector<SettingState> settings;
};

DeviceWorker::DeviceWorker(ConsoleBoard& board, std::size_t index, std::shared_ptr<devices::Device> device,
                           std::chrono::milliseconds pollEvery)
    : board_(board),
      index_(index),
      device_(std::move(device)),
      pollEvery_(pollEvery),
      halter_([this](const std::stop_token& stop) { haltWhenAsked(stop); }),
      worker_([this](const std::stop_token& stop) { work(stop); }) {}

DeviceWorker::~DeviceWorker() {
  retire();
  worker_.join();
  halter_.join();
}

void DeviceWorker::retire() {
  const auto dropped = dropTasks();
  worker_.request_stop();
  halter_.request_stop();
  for (const auto& task : dropped) task.done(device_->name() + ": " + kStopped);
}

void DeviceWorker::give(DeviceTask task) {
  {
    const std::lock_guard lock(mutex_);
    if (tasks_.size() < kMostWaiting) tasks_.push_back(std::exchange(task, {}));
  }
  if (task.done) return task.done(refusal());
  showWaiting();
  wake_.notify_all();
}

bool DeviceWorker::isFull() {
  const std::lock_guard lock(mutex_);
  return tasks_.size() >= kMostWaiting;
}

std::string DeviceWorker::refusal() const {
  return device_->name() + ": " + std::to_string(kMostWaiting) +
         " commands wait for it already; stop all drops them (halt)";
}

void DeviceWorker::halt(std::function<void(const std::string& error)> done) {
  const auto dropped = dropTasks();
  {
    const std::lock_guard lock(mutex_);
    halts_.push_back(std::move(done));
  }
  wake_.notify_all();
  for (const auto& task : dropped) task.done(device_->name() + ": " + kStopped);
  showWaiting();
}

void DeviceWorker::lookAgain() {
  {
    const std::lock_guard lock(mutex_);
    look_ = true;
  }
  wake_.notify_all();
}

std::vector<DeviceTask> DeviceWorker::dropTasks() {
  const std::lock_guard lock(mutex_);
  std::vector<DeviceTask> dropped(std::make_move_iterator(tasks_.begin()), std::make_move_iterator(tasks_.end()));
  tasks_.clear();
  running_.request_stop();
  return dropped;
}

bool DeviceWorker::hasTasks() {
  const std::lock_guard lock(mutex_);
  return !tasks_.empty();
}

void DeviceWorker::showWaiting() {
  board_.changeDevice(index_, [this](DeviceState& state) {
    const std::lock_guard lock(mutex_);
    state.waiting = static_cast<int>(tasks_.size());
  });
}

void DeviceWorker::haltWhenAsked(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return !halts_.empty(); })) {
    // One halt is as good as several.
    const auto asked = std::exchange(halts_, {});
    lock.unlock();
    std::string error;
    try {
      device_->halt();
      succeeded();
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    for (const auto& done : asked) done(error);
    lookAgain();
    lock.lock();
  }
}

void DeviceWorker::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::optional<DeviceTask> task;
    {
      std::unique_lock lock(mutex_);
      const auto pause = lost_ ? std::chrono::milliseconds(kLostPause) : pollEvery_;
      wake_.wait_for(lock, stop, pause, [this] { return look_ || !tasks_.empty(); });
      if (stop.stop_requested()) return;
      look_ = false;
      if (!tasks_.empty()) {
        task = std::move(tasks_.front());
        tasks_.pop_front();
        running_ = std::stop_source();
      }
    }
    if (task) run(*task);
    if (!hasTasks()) poll(stop);
  }
}

void DeviceWorker::run(const DeviceTask& task) {
  const std::stop_token stop = [this] {
    const std::lock_guard lock(mutex_);
    return running_.get_token();
  }();
  const auto show = [&](const std::string& doing) {
    board_.changeDevice(index_, [&](DeviceState& state) { state.doing = doing; });
  };
  show(task.text);
  showWaiting();
  const devices::Progress progress{.stop = stop, .report = show};
  std::string error;
  try {
    DeviceOutcome outcome;
    runDeviceSteps(*device_, task.steps, progress, outcome);
    succeeded();
    readBack(task.steps);
  } catch (const std::exception& failure) {
    error = failure.what();
    // What is stopped fails, but nothing is wrong with the device.
    if (!stop.stop_requested()) {
      board_.changeDevice(index_, [&](DeviceState& state) { state.trouble = error; });
    }
  }
  show("");
  task.done(error);
}

/// So that nobody who waited for a command's end still sees what was before it.
void DeviceWorker::readBack(const std::vector<DeviceStep>& steps) {
  for (const auto& step : steps) {
    if (step.kind != DeviceStep::Kind::kWrite && step.kind != DeviceStep::Kind::kNudge) continue;
    std::string value;
    try {
      value = devices::textOf(device_->read(step.name));
    } catch (const std::exception&) {
      continue;  // it cannot be read, or not now
    }
    board_.changeDevice(index_, [&](DeviceState& state) {
      for (auto& setting : state.settings) {
        if (setting.info.name == step.name) setting.value = value;
      }
    });
  }
}

void DeviceWorker::poll(const std::stop_token& stop) {
  try {
    readAll(stop);
    if (lost_) board_.log(LogLine::Kind::kNote, device_->name() + " answers again");
    lost_ = false;
  } catch (const devices::LineError& error) {
    // A halt went before; there will be another look.
    if (error.failure() != devices::LineFailure::kInterrupted) failed(error.what());
  } catch (const std::exception& error) {
    failed(error.what());
  }
}

void DeviceWorker::succeeded() {
  board_.changeDevice(index_, [](DeviceState& state) { state.trouble.clear(); });
}

void DeviceWorker::failed(const std::string& why) {
  board_.changeDevice(index_, [&](DeviceState& state) {
    state.contact = DeviceState::Contact::kLost;
    state.trouble = why;
  });
  if (!lost_) board_.log(LogLine::Kind::kError, why);
  lost_ = true;
}

/// One setting after the other, as long as nobody waits for the device.
void DeviceWorker::readAll(const std::stop_token& stop) {
  constexpr std::chrono::seconds kShowEvery{1};
  Reading reading{.identity = device_->identity(), .actions = device_->actions()};
  for (const auto& info : device_->settings()) reading.settings.push_back({info, valueBefore(info.name)});
  auto shown = std::chrono::steady_clock::now();
  bool awake = true;
  for (auto& [info, value] : reading.settings) {
    if (stop.stop_requested() || hasTasks()) return;
    value = info.readable && awake ? read(info.name) : "";
    // In standby there is nothing else to be heard.
    if (info.name == "power") awake = value == "on";
    if (std::chrono::steady_clock::now() - shown < kShowEvery) continue;
    shown = std::chrono::steady_clock::now();
    show(reading, false);
  }
  show(reading, true);
}

/// Empty when it cannot be told now.
std::string DeviceWorker::read(const std::string& setting) {
  try {
    return devices::textOf(device_->read(setting));
  } catch (const devices::DeviceError&) {
    return "";
  }
}

std::string DeviceWorker::valueBefore(const std::string& setting) const {
  const auto wall = board_.snapshot();
  const auto* state = wall->devices.at(index_)->find(setting);
  return state == nullptr ? "" : state->value;
}

void DeviceWorker::show(const Reading& reading, bool whole) {
  board_.changeDevice(index_, [&](DeviceState& state) {
    // What went wrong with a command is said until one goes well; a lost line is well when it is back.
    if (whole && state.contact == DeviceState::Contact::kLost) state.trouble.clear();
    if (whole) state.contact = DeviceState::Contact::kWell;
    state.identity = reading.identity;
    state.actions = reading.actions;
    state.settings = reading.settings;
  });
}

}  // namespace pixelflex::viewer
