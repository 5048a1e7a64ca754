#include "viewer/control/wall_console.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "calib/store/store.h"
#include "viewer/control/child_program.h"
#include "viewer/control/device_run.h"
#include "viewer/control/wall_console_parts.h"

namespace pixelflex::viewer {
namespace {

using Kind = ConsoleJob::Kind;

/// Ends a job when the last of several devices is done.
class Tally {
 public:
  Tally(ConsoleBoard& board, int job, std::size_t devices) : board_(board), job_(job), open_(devices) {}

  void done(const std::string& error) {
    const std::lock_guard lock(mutex_);
    if (!error.empty()) errors_ += (errors_.empty() ? "" : "\n") + error;
    if (--open_ == 0) board_.endJob(job_, errors_);
  }

 private:
  ConsoleBoard& board_;
  int job_;
  std::mutex mutex_;
  std::size_t open_;
  std::string errors_;
};

/// As a shell takes it for one word.
std::string quoted(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-+=.,:/@%~").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string textOf(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

std::string textOf(const DeviceStep& step) {
  if (step.kind == DeviceStep::Kind::kWrite) return step.name + "=" + step.value;
  if (step.kind != DeviceStep::Kind::kNudge) return step.name;
  return step.name + (step.by < 0 ? "-=" : "+=") + devices::textOf(std::abs(step.by));
}

std::string textOf(const std::vector<DeviceStep>& steps) {
  std::string text;
  for (const auto& step : steps) text += (text.empty() ? "" : " ") + textOf(step);
  return text;
}

}  // namespace

WallConsole::Parts::Parts(const std::filesystem::path& wallFolder, const WallConsoleOptions& consoleOptions)
    : folder(wallFolder),
      options(consoleOptions),
      wall(std::make_shared<const calib::Wall>(calib::loadWall(wallFolder))),
      devices(calib::devicesOf(*wall, wallFolder)),
      board(wall, devices),
      watch(board, wallFolder, consoleOptions.pollEvery),
      longJob(board) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    auto& worker = workers.emplace_back();
    try {
      worker =
          std::make_unique<DeviceWorker>(board, i, openDevice(loop, devices[i], options.infocusGap), options.pollEvery);
    } catch (const std::exception& error) {
      board.log(LogLine::Kind::kError, error.what());
      board.changeDevice(i, [&](DeviceState& state) {
        state.contact = DeviceState::Contact::kLost;
        state.trouble = error.what();
      });
    }
  }
}

/// All at a time.
WallConsole::Parts::~Parts() {
  for (const auto& worker : workers) {
    if (worker) worker->retire();
  }
}

DeviceWorker* WallConsole::Parts::workerOf(const std::string& device) const {
  const auto found = std::ranges::find(devices, device, &calib::WallDevice::name);
  return found == devices.end() ? nullptr : workers.at(static_cast<std::size_t>(found - devices.begin())).get();
}

/// One device that is lost must not hold up the others: that of several is an error of the job.
void WallConsole::Parts::requireRoom(const std::vector<DeviceJob>& jobs) const {
  std::string refusals;
  for (const auto& job : jobs) {
    DeviceWorker* worker = workerOf(job.device.name);
    if (worker == nullptr || !worker->isFull()) return;
    refusals += (refusals.empty() ? "" : "\n") + worker->refusal();
  }
  if (!refusals.empty()) throw std::runtime_error(refusals);
}

void WallConsole::Parts::lookAgain() const {
  for (const auto& worker : workers) {
    if (worker) worker->lookAgain();
  }
}

WallConsole::WallConsole(std::filesystem::path folder, const WallConsoleOptions& options)
    : folder_(std::move(folder)), parts_(std::make_unique<Parts>(folder_, options)) {
  if (parts_->options.programs.empty()) parts_->options.programs = programsFolder();
}

WallConsole::~WallConsole() = default;

std::shared_ptr<const WallSnapshot> WallConsole::snapshot() const {
  return parts_->board.snapshot();
}

std::string WallConsole::commandLine(const std::string& program, const std::vector<std::string>& arguments) const {
  const std::string rest = textOf(arguments);
  return "pixelflex " + program + " " + quoted(folder_.string()) + (rest.empty() ? "" : " " + rest);
}

int WallConsole::device(const std::string& names, const std::vector<std::string>& steps) {
  const auto jobs = planDevices(parts_->devices, names, steps);
  parts_->requireRoom(jobs);
  std::vector<std::string> words = {names};
  words.insert(words.end(), steps.begin(), steps.end());
  const int number = parts_->board.beginJob(Kind::kDevice, commandLine("device", words));
  const auto tally = std::make_shared<Tally>(parts_->board, number, jobs.size());
  for (const auto& job : jobs) {
    if (DeviceWorker* worker = parts_->workerOf(job.device.name)) {
      worker->give({textOf(job.steps), job.steps, [tally](const std::string& error) { tally->done(error); }});
    } else {
      tally->done(job.device.name + ": wall.yaml does not describe a device that can be used");
    }
  }
  return number;
}

int WallConsole::stopAll() {
  const int number = parts_->board.beginJob(Kind::kDevice, commandLine("device", {"all", "halt"}));
  parts_->longJob.cancel(Kind::kPreset);
  const auto able =
      static_cast<std::size_t>(std::ranges::count_if(parts_->workers, [](const auto& w) { return w != nullptr; }));
  if (able == 0) parts_->board.endJob(number, "");
  const auto tally = std::make_shared<Tally>(parts_->board, number, able);
  for (const auto& worker : parts_->workers) {
    if (worker) worker->halt([tally](const std::string& error) { tally->done(error); });
  }
  return number;
}

void WallConsole::cancel(int job) {
  parts_->longJob.cancel(job);
}

void WallConsole::log(LogLine::Kind kind, const std::string& text) {
  parts_->board.log(kind, text);
}

}  // namespace pixelflex::viewer
