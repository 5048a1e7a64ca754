#include "viewer/control/wall_watch.h"

#include <sys/stat.h>

#include <exception>
#include <utility>

#include "calib/store/preset.h"
#include "calib/store/store.h"

namespace pixelflex::viewer {
namespace {

namespace fs = std::filesystem;

/// Another one when the file was written again: files are replaced, and two in one tick of the clock differ in more
/// than their times.
std::string stampOf(const fs::path& file) {
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0) return file.filename().string() + " none\n";
  return file.filename().string() + " " + std::to_string(about.st_ino) + " " + std::to_string(about.st_size) + " " +
         std::to_string(about.st_mtim.tv_sec) + "." + std::to_string(about.st_mtim.tv_nsec) + "\n";
}

}  // namespace

WallWatch::WallWatch(ConsoleBoard& board, fs::path folder, std::chrono::milliseconds every)
    : board_(board),
      folder_(std::move(folder)),
      every_(every),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void WallWatch::lookAgain() {
  {
    const std::lock_guard lock(mutex_);
    look_ = true;
  }
  wake_.notify_all();
}

void WallWatch::watch(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, every_, [this] { return look_; });
      look_ = false;
    }
    if (!stop.stop_requested()) look();
  }
}

void WallWatch::look() {
  const std::string calibration = stampOf(folder_ / "calibration.yaml") + stampOf(folder_ / "nudge.yaml");
  if (calibration != std::exchange(calibrationStamp_, calibration)) readCalibration();
  std::string presets = calibration;
  std::vector<PresetInfo> infos;
  try {
    const auto names = calib::presetNames(folder_);
    for (const auto& name : names) presets += stampOf(folder_ / "presets" / (name + ".yaml"));
    if (presets == std::exchange(presetStamp_, presets)) return;
    for (const auto& name : names) infos.push_back(readPreset(name));
  } catch (const std::exception& error) {
    board_.log(LogLine::Kind::kError, error.what());
  }
  board_.setPresets(std::move(infos));
}

void WallWatch::readCalibration() {
  if (!calib::hasCalibration(folder_)) return board_.setCalibration(nullptr, "");
  try {
    board_.setCalibration(std::make_shared<const calib::Calibration>(calib::loadCalibration(folder_)), "");
  } catch (const std::exception& error) {
    board_.setCalibration(nullptr, error.what());
    board_.log(LogLine::Kind::kError, error.what());
  }
}

PresetInfo WallWatch::readPreset(const std::string& name) const {
  PresetInfo info{.name = name};
  try {
    const calib::Preset preset = calib::loadPreset(folder_, name);
    info.saved = preset.saved;
    info.devices = preset.devices.size();
    info.hasCalibration = preset.calibration.has_value();
    info.calibrationInUse = preset.calibration && calib::isCalibrationInUse(folder_, *preset.calibration);
  } catch (const std::exception& error) {
    info.trouble = error.what();
  }
  return info;
}

}  // namespace pixelflex::viewer
