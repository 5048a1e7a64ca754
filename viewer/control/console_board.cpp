#include "viewer/control/console_board.h"

#include <algorithm>
#include <utility>

namespace pixelflex::viewer {

ConsoleBoard::ConsoleBoard(std::shared_ptr<const calib::Wall> wall, const std::vector<calib::WallDevice>& devices) {
  state_.wall = std::move(wall);
  for (const auto& device : devices) {
    DeviceState state;
    state.device = device;
    state_.devices.push_back(std::make_shared<const DeviceState>(std::move(state)));
  }
}

std::shared_ptr<const WallSnapshot> ConsoleBoard::snapshot() const {
  const std::lock_guard lock(mutex_);
  if (!published_ || published_->revision != state_.revision) {
    published_ = std::make_shared<const WallSnapshot>(state_);
  }
  return published_;
}

void ConsoleBoard::changeDevice(std::size_t device, const std::function<void(DeviceState& state)>& change) {
  const std::lock_guard lock(mutex_);
  auto state = std::make_shared<DeviceState>(*state_.devices.at(device));
  change(*state);
  state_.devices.at(device) = std::move(state);
  changed();
}

int ConsoleBoard::beginJob(ConsoleJob::Kind kind, const std::string& command) {
  const std::lock_guard lock(mutex_);
  logLocked(LogLine::Kind::kCommand, command);
  state_.jobs.push_back({.number = ++jobs_, .kind = kind, .command = command});
  changed();
  return jobs_;
}

ConsoleJob* ConsoleBoard::jobLocked(int job) {
  const auto found = std::ranges::find(state_.jobs, job, &ConsoleJob::number);
  return found == state_.jobs.end() ? nullptr : &*found;
}

void ConsoleBoard::changeJob(int job, const std::function<void(ConsoleJob& state)>& change) {
  const std::lock_guard lock(mutex_);
  if (ConsoleJob* found = jobLocked(job)) change(*found);
  changed();
}

void ConsoleBoard::endJob(int job, const std::string& error) {
  const std::lock_guard lock(mutex_);
  if (!error.empty()) logLocked(LogLine::Kind::kError, error);
  if (ConsoleJob* found = jobLocked(job)) {
    found->running = false;
    found->error = error;
  }
  forgetEndedJobs();
  changed();
}

void ConsoleBoard::forgetEndedJobs() {
  auto ended = static_cast<std::size_t>(std::ranges::count(state_.jobs, false, &ConsoleJob::running));
  std::erase_if(state_.jobs, [&](const ConsoleJob& job) {
    if (job.running || ended <= kEndedJobs) return false;
    --ended;
    return true;
  });
}

bool ConsoleBoard::isRunning(ConsoleJob::Kind kind) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(state_.jobs, [&](const ConsoleJob& job) { return job.running && job.kind == kind; });
}

void ConsoleBoard::log(LogLine::Kind kind, std::string_view text) {
  const std::lock_guard lock(mutex_);
  logLocked(kind, text);
  changed();
}

void ConsoleBoard::logLocked(LogLine::Kind kind, std::string_view text) {
  LogLine line{.number = ++lines_, .at = std::chrono::system_clock::now(), .kind = kind, .text = std::string(text)};
  state_.log.push_back(std::make_shared<const LogLine>(std::move(line)));
  if (state_.log.size() > kLogLines) state_.log.erase(state_.log.begin());
}

void ConsoleBoard::setPresets(std::vector<PresetInfo> presets) {
  const std::lock_guard lock(mutex_);
  state_.presets = std::move(presets);
  changed();
}

void ConsoleBoard::setCalibration(std::shared_ptr<const calib::Calibration> calibration, const std::string& trouble) {
  const std::lock_guard lock(mutex_);
  state_.calibration = std::move(calibration);
  state_.calibrationTrouble = trouble;
  changed();
}

}  // namespace pixelflex::viewer
