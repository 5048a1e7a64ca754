#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "calib/store/store_checks.h"
#include "calib/store/yaml_reader.h"
#include "calib/store/yaml_text.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using Node = YamlReader::Node;

constexpr std::size_t kMaxSettings = 64;

fs::path presetFolder(const fs::path& folder) {
  return folder / "presets";
}

fs::path presetFile(const fs::path& folder, const std::string& name) {
  return presetFolder(folder) / (name + ".yaml");
}

PresetDevice readDevice(const Node& node) {
  PresetDevice device;
  device.name = readName(node.required("name"));
  device.driver = readText(node.required("driver"), kMaxName);
  const Node settings = node.required("settings");
  const auto keys = settings.keys();
  if (keys.size() > kMaxSettings) settings.problem("more settings than any device has");
  for (const auto& key : keys) {
    device.settings.emplace_back(key, readText(settings.optional(key), kMaxName));
  }
  node.refuseUnknownKeys();
  return device;
}

/// Of presets/ alone, so that no file leads out of it.
std::string readKept(const Node& node) {
  std::string kept = readText(node, kMaxName);
  if (!kept.starts_with("presets/calibration-") || kept.find("..") != std::string::npos) {
    node.problem("this is no copy of a calibration that preset has made");
  }
  return kept;
}

void removeUnused(const fs::path& folder) {
  std::set<std::string> used;
  for (const auto& name : presetNames(folder)) used.insert(loadPreset(folder, name).calibration.value_or(""));
  const fs::path current = folder / "calibration.yaml";
  const std::string text = fs::exists(current) ? readStoreFile(current.string()) : "";
  for (const auto& entry : fs::directory_iterator(presetFolder(folder))) {
    const std::string kept = "presets/" + entry.path().filename().string();
    const bool copy = entry.is_directory() && kept.starts_with("presets/calibration-");
    if (copy && !used.contains(kept) && text.find(kept + "/") == std::string::npos) fs::remove_all(entry.path());
  }
}

}  // namespace

Preset parsePreset(std::string_view text, const std::string& file) {
  YamlReader reader(text, file);
  reader.readHeader("pixelflex-preset", kPresetVersion);
  const Node root = reader.root();
  Preset preset;
  preset.saved = readText(root.required("saved"), kMaxName);
  for (const Node& node : root.required("devices").elements(0, 2 * kMaxProjectors)) {
    preset.devices.push_back(readDevice(node));
  }
  if (const Node kept = root.optional("calibration"); kept.defined()) preset.calibration = readKept(kept);
  root.refuseUnknownKeys();
  reader.throwIfProblems();
  return preset;
}

std::string formatPreset(const Preset& preset) {
  std::string text = fmt::format(
      "# A configuration of the wall. Restore it with: pixelflex preset WALL restore NAME\n"
      "format: pixelflex-preset\nversion: {}\nsaved: {}\n",
      kPresetVersion, yamlText(preset.saved));
  if (preset.calibration) text += fmt::format("calibration: {}\n", yamlText(*preset.calibration));
  text += preset.devices.empty() ? "devices: []\n" : "devices:\n";
  for (const auto& device : preset.devices) {
    std::string settings;
    for (const auto& [name, value] : device.settings) {
      settings += fmt::format("{}{}: {}", settings.empty() ? "" : ", ", yamlText(name), yamlText(value));
    }
    text += fmt::format("  - {{name: {}, driver: {}, settings: {{{}}}}}\n", yamlText(device.name),
                        yamlText(device.driver), settings);
  }
  return text;
}

void checkPresetName(const std::string& name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  if (!name.empty() && name.size() <= kMaxName && name.front() != '.' && std::ranges::all_of(name, fits)) return;
  throw StoreError({{"", 0, 0,
                     "\"" + name.substr(0, kMaxName) +
                         "\": a preset's name is made of letters, digits, '_', '-' and '.', not first"}});
}

std::vector<std::string> presetNames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(presetFolder(folder), error)) {
    const bool preset = entry.is_regular_file() && entry.path().extension() == ".yaml";
    if (preset && !entry.path().filename().string().starts_with('.')) names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

Preset loadPreset(const fs::path& folder, const std::string& name) {
  checkPresetName(name);
  const fs::path path = presetFile(folder, name);
  if (fs::exists(path)) return parsePreset(readStoreFile(path.string()), path.string());
  std::string list;
  for (const auto& known : presetNames(folder)) list += (list.empty() ? "" : ", ") + known;
  throw StoreError(
      {{path.string(), 0, 0,
        "there is no preset of that name; " + (list.empty() ? "none was saved yet" : "there are " + list)}});
}

void savePreset(const fs::path& folder, const std::string& name, const Preset& preset) {
  checkPresetName(name);
  const fs::path path = presetFile(folder, name);
  const std::string text = formatPreset(preset);
  (void)parsePreset(text, path.string());
  devices::writeFileAtomically(path, text);
  removeUnused(folder);
}

void deletePreset(const fs::path& folder, const std::string& name) {
  (void)loadPreset(folder, name);
  fs::remove(presetFile(folder, name));
  removeUnused(folder);
}

}  // namespace pixelflex::calib
