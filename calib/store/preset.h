#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

inline constexpr int kPresetVersion = 1;

/// What one device was set to: names of settings and their values as text.
struct PresetDevice {
  std::string name;    // "p1.mirror"
  std::string driver;  // as in wall.yaml then: counts of another unit would mean another angle
  std::vector<std::pair<std::string, std::string>> settings;
  bool operator==(const PresetDevice&) const = default;
};

/// presets/NAME.yaml: a wall's configuration under a name.
struct Preset {
  std::string saved;  // when, ISO 8601
  std::vector<PresetDevice> devices;
  std::optional<std::string> calibration;  // the folder of its copy, relative to the wall's; none: it had none
  bool operator==(const Preset&) const = default;
};

/// Throw StoreError.
[[nodiscard]] Preset parsePreset(std::string_view text, const std::string& file);
[[nodiscard]] std::string formatPreset(const Preset& preset);

/// A preset's name is made of letters, digits, '_', '-' and '.', not first. Throws StoreError.
void checkPresetName(const std::string& name);
/// In the order of the alphabet.
[[nodiscard]] std::vector<std::string> presetNames(const std::filesystem::path& folder);
/// Throws StoreError, which lists what presets there are.
[[nodiscard]] Preset loadPreset(const std::filesystem::path& folder, const std::string& name);
/// Atomic; replaces one of the same name.
void savePreset(const std::filesystem::path& folder, const std::string& name, const Preset& preset);
/// With the copies of calibrations that no preset and not the wall itself use any more.
void deletePreset(const std::filesystem::path& folder, const std::string& name);

/// Copies calibration.yaml with all files that it names, and nudge.yaml, into a folder of presets/ that is named after
/// their content, so that equal calibrations are kept once and a copy never changes. Returns that folder, relative to
/// the wall's; nothing when the wall has no calibration.
[[nodiscard]] std::optional<std::string> keepCalibration(const std::filesystem::path& folder);
/// Makes a kept calibration the wall's: writes calibration.yaml, which then names the kept files, in one step, and
/// nudge.yaml. Returns whether that changed anything.
bool useCalibration(const std::filesystem::path& folder, const std::string& kept);
/// Whether useCalibration() would change anything.
[[nodiscard]] bool isCalibrationInUse(const std::filesystem::path& folder, const std::string& kept);

}  // namespace pixelflex::calib
