#include "viewer/control/preset_plan.h"

#include <algorithm>
#include <optional>
#include <set>

namespace pixelflex::viewer {
namespace {

using Stage = PresetStage;
using Values = std::map<std::string, std::string>;

struct Kept {
  std::string_view setting;
  Stage stage;
};
// Speeds go with the move: they are set before it.
constexpr std::array kKept = {
    Kept{"power", Stage::kPower},       Kept{"pan_speed", Stage::kMove},   Kept{"tilt_speed", Stage::kMove},
    Kept{"pan_counts", Stage::kMove},   Kept{"tilt_counts", Stage::kMove}, Kept{"lens_memory", Stage::kLens},
    Kept{"brightness", Stage::kColour}, Kept{"contrast", Stage::kColour},  Kept{"red", Stage::kColour},
    Kept{"green", Stage::kColour},      Kept{"blue", Stage::kColour},      Kept{"input", Stage::kInput},
    Kept{"mute", Stage::kUnmute}};

std::string projectorOf(const std::string& device) {
  return device.substr(0, device.rfind('.'));
}

std::optional<std::string> valueIn(const auto& settings, std::string_view name) {
  const auto found = std::ranges::find_if(settings, [&](const auto& setting) { return setting.first == name; });
  if (found == settings.end()) return std::nullopt;
  return found->second;
}

bool disturbs(Stage stage) {
  return stage == Stage::kMove || stage == Stage::kLens || stage == Stage::kInput;
}

/// All stages but muting.
std::vector<PresetStep> changesOf(const calib::PresetDevice& device, const Values& now) {
  const bool off = valueIn(device.settings, "power") == "off";
  std::vector<PresetStep> steps;
  for (const auto& [setting, stage] : kKept) {
    const auto wanted = valueIn(device.settings, setting);
    const bool skipped = off && stage != Stage::kPower;
    if (!wanted || skipped || valueIn(now, setting) == wanted) continue;
    if (steps.empty() || steps.back().stage != stage) steps.push_back({stage, device.name, {}});
    steps.back().settings.emplace_back(setting, *wanted);
  }
  return steps;
}

}  // namespace

std::string_view nameOf(PresetStage stage) {
  constexpr std::array<std::string_view, kPresetStages.size()> kNames = {"mute",   "power", "move",        "lens",
                                                                         "colour", "input", "calibration", "unmute"};
  return kNames.at(static_cast<std::size_t>(stage));
}

bool isKeptInPreset(std::string_view setting) {
  return std::ranges::find(kKept, setting, &Kept::setting) != kKept.end();
}

std::vector<PresetStep> planPreset(const calib::Preset& preset, const DeviceValues& now) {
  std::vector<PresetStep> steps;
  std::set<std::string> disturbed;
  for (const auto& device : preset.devices) {
    const auto its = now.find(device.name);
    if (its == now.end()) continue;
    for (auto& step : changesOf(device, its->second)) {
      if (disturbs(step.stage)) disturbed.insert(projectorOf(device.name));
      steps.push_back(std::move(step));
    }
  }
  for (const auto& device : preset.devices) {
    const auto its = now.find(device.name);
    const auto wanted = valueIn(device.settings, "mute");
    if (its == now.end() || !wanted || !disturbed.contains(projectorOf(device.name))) continue;
    // What is dark already need not be muted; what was muted is unmuted at the end, where it is not so anyway.
    if (valueIn(its->second, "power") != "on" || valueIn(its->second, "mute") != "off") continue;
    steps.push_back({Stage::kMute, device.name, {{"mute", "on"}}});
    if (*wanted == "off") steps.push_back({Stage::kUnmute, device.name, {{"mute", "off"}}});
    if (*wanted == "on") {
      std::erase_if(steps,
                    [&](const PresetStep& step) { return step.device == device.name && step.stage == Stage::kUnmute; });
    }
  }
  std::ranges::stable_sort(steps, {}, &PresetStep::stage);
  return steps;
}

}  // namespace pixelflex::viewer
