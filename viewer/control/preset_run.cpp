#include "viewer/control/preset_run.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <exception>
#include <thread>
#include <utility>

#include "devices/transport/line_loop.h"
#include "viewer/control/device_run.h"

namespace pixelflex::viewer {
namespace {

using devices::DeviceError;
using devices::textOf;

std::string nowText() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace

struct PresetSession::Member {
  calib::WallDevice wanted;
  std::shared_ptr<devices::Device> device;  // none: it could not even be made
  std::map<std::string, std::string> values = {};
  PresetOutcome outcome = {};
  bool muted = false;  // by us

  /// Those that it cannot tell now are left out.
  void read(const std::vector<std::string>& settings) {
    for (const auto& setting : settings) {
      try {
        values[setting] = textOf(device->read(setting));
      } catch (const DeviceError&) {
        values.erase(setting);
      }
      // In standby there is nothing else to be heard.
      if (setting == "power" && values.contains("power") && values["power"] == "off") return;
    }
  }
};

PresetSession::PresetSession(devices::LineLoop& loop, const std::filesystem::path& folder,
                             const std::vector<calib::WallDevice>& devices, PresetRunOptions options)
    : folder_(folder), options_(std::move(options)) {
  for (const auto& device : devices) {
    auto member = std::make_unique<Member>(Member{.wanted = device, .device = nullptr});
    member->outcome.device = device.name;
    try {
      if (options_.borrow) member->device = options_.borrow(device);
      if (!member->device) member->device = openDevice(loop, device, options_.infocusGap);
    } catch (const std::exception& error) {
      member->outcome.error = error.what();
    }
    members_.push_back(std::move(member));
  }
}

PresetSession::~PresetSession() = default;

std::vector<PresetSession::Member*> PresetSession::well() {
  std::vector<Member*> members;
  for (const auto& member : members_) {
    if (member->outcome.error.empty()) members.push_back(member.get());
  }
  return members;
}

PresetSession::Member* PresetSession::find(const std::string& device) {
  const auto found = std::ranges::find_if(members_, [&](const auto& member) { return member->wanted.name == device; });
  return found == members_.end() ? nullptr : found->get();
}

void PresetSession::forEach(const std::vector<Member*>& members, const std::function<void(Member&)>& action) {
  std::vector<std::jthread> threads;
  for (Member* member : members) {
    threads.emplace_back([member, &action] {
      try {
        action(*member);
      } catch (const std::exception& error) {
        // What went wrong first says most.
        if (member->outcome.error.empty()) member->outcome.error = error.what();
      }
    });
  }
}

void PresetSession::collect() {
  outcomes_.clear();
  for (const auto& member : members_) outcomes_.push_back(member->outcome);
}

calib::Preset PresetSession::capture() {
  forEach(well(), [](Member& member) {
    const auto infos = member.device->settings();
    std::vector<std::string> wanted;
    for (const auto& info : infos) {
      if (info.readable && info.settable && isKeptInPreset(info.name)) wanted.push_back(info.name);
    }
    member.read(wanted);
    // A value that cannot be set, such as an input that the driver has no word for, cannot be restored either.
    for (const auto& info : infos) {
      const bool known = !info.words || info.name == "power" ||
                         std::ranges::find(info.choices, member.values[info.name]) != info.choices.end();
      if (!known) member.values.erase(info.name);
    }
  });
  collect();
  calib::Preset preset{.saved = nowText(), .devices = {}, .calibration = calib::keepCalibration(folder_)};
  for (const auto& member : members_) {
    if (!member->outcome.error.empty()) continue;
    calib::PresetDevice device{member->wanted.name, member->wanted.line.driver, {}};
    // A lamp that is changing will be what it is changing to.
    for (const auto& [name, value] : member->values) {
      const bool cools = name == "power" && value != "on" && value != "warming";
      device.settings.emplace_back(name, name == "power" ? (cools ? "off" : "on") : value);
    }
    preset.devices.push_back(std::move(device));
  }
  return preset;
}

calib::Preset PresetSession::captureAs(const std::string& name) {
  calib::Preset preset = capture();
  const auto failed = [](const PresetOutcome& outcome) { return !outcome.error.empty(); };
  if (!outcomes_.empty() && std::ranges::all_of(outcomes_, failed)) {
    throw std::runtime_error("no device could be read, so " + name + " was not saved; " + outcomes_.front().error);
  }
  if (std::ranges::none_of(outcomes_, failed)) return preset;
  const auto known = calib::presetNames(folder_);
  if (std::ranges::find(known, name) == known.end()) return preset;
  const calib::Preset earlier = calib::loadPreset(folder_, name);
  for (const auto& device : earlier.devices) {
    const auto outcome = std::ranges::find(outcomes_, device.name, &PresetOutcome::device);
    if (outcome != outcomes_.end() && failed(*outcome)) preset.devices.push_back(device);
  }
  return preset;
}

std::vector<PresetStep> PresetSession::prepare(const calib::Preset& preset) {
  DeviceValues now;
  std::vector<Member*> wanted;
  for (const auto& device : preset.devices) {
    Member* member = find(device.name);
    if (member == nullptr) {
      outcomes_.push_back({device.name, 0, device.name + ": wall.yaml has no such device any more"});
    } else if (member->wanted.line.driver != device.driver) {
      member->outcome.error = device.name + ": the preset is of another driver, " + device.driver;
    } else if (member->outcome.error.empty()) {
      wanted.push_back(member);
    }
  }
  const std::vector<PresetOutcome> unknown = std::exchange(outcomes_, {});
  forEach(wanted, [&](Member& member) {
    std::vector<std::string> names = {};
    const auto device = std::ranges::find(preset.devices, member.wanted.name, &calib::PresetDevice::name);
    for (const auto& [name, value] : device->settings) names.push_back(name);
    // The power first: it says whether the rest can be asked for.
    std::ranges::stable_partition(names, [](const std::string& name) { return name == "power"; });
    member.read(names);
  });
  for (const Member* member : wanted) {
    if (member->outcome.error.empty()) now[member->wanted.name] = member->values;
  }
  collect();
  outcomes_.insert(outcomes_.end(), unknown.begin(), unknown.end());
  return planPreset(preset, now);
}

void PresetSession::runStage(PresetStage stage, const std::vector<PresetStep>& plan) {
  const bool unmutes = stage == PresetStage::kUnmute;
  std::map<const Member*, const PresetStep*> steps;
  std::vector<Member*> members;
  for (const auto& step : plan) {
    if (step.stage != stage) continue;
    Member* member = find(step.device);
    // What was muted is not left so, whatever went wrong in between.
    if (!member->outcome.error.empty() && !(unmutes && member->muted)) continue;
    steps[member] = &step;
    members.push_back(member);
  }
  forEach(members, [&](Member& member) {
    const bool stopped = options_.stop.stop_requested();
    if (stopped && !(unmutes && member.muted)) throw DeviceError(member.wanted.name + ": stopped on request");
    const devices::Progress progress{.stop = unmutes ? std::stop_token() : options_.stop,
                                     .report = [&](const std::string& state) {
                                       const std::lock_guard lock(reporting_);
                                       if (options_.report) options_.report(member.wanted.name, state);
                                     }};
    const PresetStep& step = *steps.at(&member);
    std::vector<std::pair<std::string, devices::SettingValue>> values;
    for (const auto& [name, value] : step.settings) values.emplace_back(name, value);
    member.device->writeAll(values, progress);
    if (stage == PresetStage::kMute) member.muted = true;
    member.outcome.changed += static_cast<int>(values.size());
  });
}

void PresetSession::restore(const calib::Preset& preset, const std::vector<PresetStep>& plan,
                            const std::function<void(PresetStage stage)>& atStage) {
  const std::vector<PresetOutcome> before = outcomes_;
  std::string calibrationError;
  // Looked up first: a copy that is missing is said before anything is muted.
  const bool differs = preset.calibration && !calib::isCalibrationInUse(folder_, *preset.calibration);
  for (const PresetStage stage : kPresetStages) {
    const bool calibrates = stage == PresetStage::kCalibration && differs;
    const bool has = std::ranges::any_of(plan, [&](const PresetStep& step) { return step.stage == stage; });
    if (!has && !calibrates) continue;
    if (calibrates && options_.stop.stop_requested()) continue;
    atStage(stage);
    if (calibrates) calibrationError = useCalibration(*preset.calibration);
    runStage(stage, plan);
  }
  collect();
  // Those that are no members.
  for (std::size_t i = members_.size(); i < before.size(); ++i) outcomes_.push_back(before[i]);
  if (!calibrationError.empty()) outcomes_.push_back({"calibration", 0, calibrationError});
}

/// What went wrong; those that were muted are to be unmuted all the same.
std::string PresetSession::useCalibration(const std::string& kept) const {
  try {
    (void)calib::useCalibration(folder_, kept);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace pixelflex::viewer
