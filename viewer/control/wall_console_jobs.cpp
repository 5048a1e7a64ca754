// The long jobs of a WallConsole: presets and calibration.

#include <charconv>
#include <stdexcept>
#include <string_view>

#include "calib/store/preset.h"
#include "viewer/control/child_program.h"
#include "viewer/control/preset_plan.h"
#include "viewer/control/wall_console_parts.h"

namespace pixelflex::viewer {
namespace {

using Kind = ConsoleJob::Kind;

void throwErrors(const std::vector<PresetOutcome>& outcomes) {
  std::string errors;
  for (const auto& outcome : outcomes) {
    if (!outcome.error.empty()) errors += (errors.empty() ? "" : "\n") + outcome.error;
  }
  if (!errors.empty()) throw std::runtime_error(errors);
}

std::string textOf(const PresetStep& step) {
  std::string text = std::string(nameOf(step.stage)) + "  " + step.device + " ";
  for (const auto& [name, value] : step.settings) text += " " + name + "=" + value;
  return text;
}

std::optional<int> takeNumber(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end == text.data() + text.size() || *end != ' ') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  return number;
}

/// "progress STEP DONE TOTAL WHAT", as pixelflex-calibrate --progress prints it.
bool tellProgress(const JobView& view, std::string_view line) {
  constexpr std::string_view kProgress = "progress ";
  if (!line.starts_with(kProgress)) return false;
  line.remove_prefix(kProgress.size());
  const auto blank = line.find(' ');
  if (blank == std::string_view::npos) return false;
  const std::string step(line.substr(0, blank));
  line.remove_prefix(blank + 1);
  const auto done = takeNumber(line);
  const auto total = done ? takeNumber(line) : std::nullopt;
  if (!total) return false;
  const std::string of = *total > 0 ? " of " + std::to_string(*total) : "";
  view.tell(step + " " + std::to_string(*done) + of + (line.empty() ? "" : ", ") + std::string(line),
            *total > 0 ? std::optional(1.0 * *done / *total) : std::nullopt);
  return true;
}

/// Its lines are the job's; throws what it complains about.
void runCalibrate(const JobView& view, const std::filesystem::path& programs, std::vector<std::string> arguments) {
  arguments.emplace_back("--progress");
  std::string errors;
  const int status = runChildProgram(programs / "pixelflex-calibrate", arguments, view.stop,
                                     [&](const std::string& text, bool isError) {
                                       if (!isError && tellProgress(view, text)) return;
                                       if (isError) errors += (errors.empty() ? "" : "\n") + text;
                                       if (!isError && !text.empty()) view.say(text);
                                     });
  if (view.stop.stop_requested()) throw std::runtime_error("pixelflex-calibrate: stopped on request");
  if (status != 0 && errors.empty()) errors = "pixelflex-calibrate ended with status " + std::to_string(status);
  if (status != 0) throw std::runtime_error(errors);
  if (!errors.empty()) view.board.log(LogLine::Kind::kNote, errors);
}

bool hasCamera(const calib::Wall& wall) {
  return !wall.isFlat() && wall.camera.source != "none" && wall.camera.source != "photos";
}

}  // namespace

PresetSession WallConsole::Parts::presetSession(const JobView& view) {
  PresetRunOptions run{.stop = view.stop, .infocusGap = options.infocusGap};
  run.report = [view](const std::string& device, const std::string& state) {
    view.board.changeJob(view.number, [&](ConsoleJob& job) { job.state = device + ": " + state; });
  };
  run.borrow = [this](const calib::WallDevice& device) {
    const DeviceWorker* worker = workerOf(device.name);
    return worker == nullptr ? nullptr : worker->device();
  };
  return {loop, folder, devices, run};
}

int WallConsole::savePreset(const std::string& name) {
  calib::checkPresetName(name);
  return parts_->longJob.start(Kind::kPreset, commandLine("preset", {"save", name}), [this, name](const JobView& view) {
    view.tell("reading all devices");
    PresetSession session = parts_->presetSession(view);
    const calib::Preset preset = session.captureAs(name);
    calib::savePreset(folder_, name, preset);
    view.say(name + ": " + std::to_string(preset.devices.size()) + " devices" +
             (preset.calibration ? " and the calibration" : ", no calibration"));
    parts_->watch.lookAgain();
    throwErrors(session.outcomes());
  });
}

int WallConsole::planPreset(const std::string& name) {
  const std::string command = commandLine("preset", {"restore", name, "--dry-run"});
  return parts_->longJob.start(Kind::kPreset, command, [this, name](const JobView& view) {
    view.tell("reading all devices");
    PresetSession session = parts_->presetSession(view);
    const calib::Preset preset = calib::loadPreset(folder_, name);
    const auto plan = session.prepare(preset);
    const bool calibrates = preset.calibration && !calib::isCalibrationInUse(folder_, *preset.calibration);
    for (const PresetStage stage : kPresetStages) {
      if (stage == PresetStage::kCalibration && calibrates) view.say("calibration  the preset's");
      for (const auto& step : plan) {
        if (step.stage == stage) view.say(textOf(step));
      }
    }
    if (plan.empty() && !calibrates) view.say("all is as " + name + " has it");
    throwErrors(session.outcomes());
  });
}

int WallConsole::restorePreset(const std::string& name, bool verify) {
  std::vector<std::string> words = {"restore", name};
  if (verify) words.emplace_back("--verify");
  return parts_->longJob.start(Kind::kPreset, commandLine("preset", words), [this, name, verify](const JobView& view) {
    view.tell("reading all devices");
    PresetSession session = parts_->presetSession(view);
    const calib::Preset preset = calib::loadPreset(folder_, name);
    const auto plan = session.prepare(preset);
    session.restore(preset, plan, [&](PresetStage stage) {
      view.tell(std::string(nameOf(stage)), 1.0 * static_cast<int>(stage) / static_cast<int>(kPresetStages.size()));
    });
    int changed = 0;
    for (const auto& outcome : session.outcomes()) {
      changed += outcome.changed;
      DeviceWorker* worker = outcome.error.empty() ? parts_->workerOf(outcome.device) : nullptr;
      if (worker != nullptr) worker->succeeded();
    }
    view.say(name + ": " + std::to_string(changed) + " settings changed");
    parts_->lookAgain();
    parts_->watch.lookAgain();
    throwErrors(session.outcomes());
    if (verify && hasCamera(*parts_->wall)) runCalibrate(view, parts_->options.programs, {folder_.string(), "--check"});
  });
}

int WallConsole::deletePreset(const std::string& name) {
  return parts_->longJob.start(Kind::kPreset, commandLine("preset", {"delete", name}), [this, name](const JobView&) {
    calib::deletePreset(folder_, name);
    parts_->watch.lookAgain();
  });
}

int WallConsole::calibrate(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {folder_.string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return parts_->longJob.start(Kind::kCalibration, commandLine("calibrate", arguments),
                               [this, all](const JobView& view) {
                                 runCalibrate(view, parts_->options.programs, all);
                                 parts_->watch.lookAgain();
                               });
}

}  // namespace pixelflex::viewer
