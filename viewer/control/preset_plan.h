#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calib/store/preset.h"

namespace pixelflex::viewer {

/// In the order in which a preset is restored: nobody sees a picture wander, and lamps are warm before lenses turn.
enum class PresetStage { kMute, kPower, kMove, kLens, kColour, kInput, kCalibration, kUnmute };
inline constexpr std::array kPresetStages = {PresetStage::kMute,        PresetStage::kPower,  PresetStage::kMove,
                                             PresetStage::kLens,        PresetStage::kColour, PresetStage::kInput,
                                             PresetStage::kCalibration, PresetStage::kUnmute};
[[nodiscard]] std::string_view nameOf(PresetStage stage);

/// Settings of one device at one stage.
struct PresetStep {
  PresetStage stage = PresetStage::kMute;
  std::string device;
  std::vector<std::pair<std::string, std::string>> settings;
  bool operator==(const PresetStep&) const = default;
};

/// By device and setting, as text. What a device cannot tell now is not there, and counts as different.
using DeviceValues = std::map<std::string, std::map<std::string, std::string>>;

/// What is left to do: nothing for what is as the preset has it, nor for devices that are not in `now`. Projectors are
/// muted while their mirror or lens moves or their input changes.
[[nodiscard]] std::vector<PresetStep> planPreset(const calib::Preset& preset, const DeviceValues& now);

/// Whether a setting belongs into a preset: what was aimed and set, not what is measured or said twice.
[[nodiscard]] bool isKeptInPreset(std::string_view setting);

}  // namespace pixelflex::viewer
