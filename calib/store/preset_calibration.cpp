#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>

#include "calib/store/nudge.h"
#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

/// Every file that a calibration names.
void forEachFile(Calibration& calibration, const std::function<void(std::string& path)>& action) {
  const auto take = [&](std::optional<std::string>& path) {
    if (path) action(*path);
  };
  if (calibration.camera) take(calibration.camera->response);
  for (auto& projector : calibration.projectors) {
    take(projector.alpha);
    take(projector.response);
    if (projector.measured) action(projector.measured->white);
    if (!projector.light) continue;
    take(projector.light->gain);
    take(projector.light->black);
  }
}

/// FNV-1a: tells copies apart, no more.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) sum_ = (sum_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
    sum_ = (sum_ ^ 0xFFU) * 0x100000001B3U;
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325U;
};

std::string nudgeText(const fs::path& folder) {
  const Nudges nudges = loadNudges(folder);
  return nudges.empty() ? "" : formatNudges(nudges);
}

/// The calibration with its files as they are called in the copy, and their contents.
struct Copy {
  Calibration calibration;
  std::map<std::string, std::string> files;
};

Copy copyOf(const fs::path& folder) {
  Copy copy{loadCalibration(folder), {}};
  for (auto& projector : copy.calibration.projectors) projector.nudge.reset();
  std::map<std::string, std::string> origins;
  forEachFile(copy.calibration, [&](std::string& path) {
    const std::string name = fs::path(path).filename().string();
    const auto [place, fresh] = origins.emplace(name, path);
    if (!fresh && place->second != path) {
      throw StoreError({{path, 0, 0, "a preset cannot hold two files of the same name: rename one of them"}});
    }
    if (fresh) copy.files[name] = readStoreFile((folder / path).string());
    path = name;
  });
  return copy;
}

std::string currentText(const fs::path& folder) {
  const fs::path path = folder / "calibration.yaml";
  return fs::exists(path) ? readStoreFile(path.string()) : "";
}

Calibration keptCalibration(const fs::path& folder, const std::string& kept) {
  Calibration calibration = loadCalibration(folder / kept);
  for (auto& projector : calibration.projectors) projector.nudge.reset();
  forEachFile(calibration, [&](std::string& path) { path = (fs::path(kept) / path).string(); });
  return calibration;
}

}  // namespace

std::optional<std::string> keepCalibration(const fs::path& folder) {
  if (!hasCalibration(folder)) return std::nullopt;
  const Copy copy = copyOf(folder);
  const std::string nudges = nudgeText(folder);
  const std::string text = formatCalibration(copy.calibration);
  Fingerprint fingerprint;
  fingerprint.add(text);
  fingerprint.add(nudges);
  for (const auto& [name, bytes] : copy.files) fingerprint.add(bytes);
  const std::string kept = "presets/calibration-" + fingerprint.text();
  if (hasCalibration(folder / kept)) return kept;
  for (const auto& [name, bytes] : copy.files) devices::writeFileAtomically(folder / kept / name, bytes);
  if (!nudges.empty()) devices::writeFileAtomically(folder / kept / "nudge.yaml", nudges);
  // Last: where it is, the copy is whole.
  devices::writeFileAtomically(folder / kept / "calibration.yaml", text);
  return kept;
}

bool isCalibrationInUse(const fs::path& folder, const std::string& kept) {
  return currentText(folder) == formatCalibration(keptCalibration(folder, kept)) &&
         nudgeText(folder) == nudgeText(folder / kept);
}

bool useCalibration(const fs::path& folder, const std::string& kept) {
  if (isCalibrationInUse(folder, kept)) return false;
  const Calibration calibration = keptCalibration(folder, kept);
  saveNudges(folder, loadNudges(folder / kept));
  saveCalibration(folder, calibration);
  return true;
}

}  // namespace pixelflex::calib
