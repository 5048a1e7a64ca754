#include "viewer/remote/wall_remote.h"

#include <algorithm>
#include <array>
#include <functional>

#include "calib/store/preset.h"
#include "calib/store/store.h"
#include "viewer/remote/remote_error.h"

namespace pixelflex::viewer {
namespace {

using Contact = DeviceState::Contact;
using Kind = RemoteError::Kind;
using Power = WallSummary::Power;

bool isKnownToLack(const DeviceState& device, const std::string& setting) {
  return !device.settings.empty() && device.find(setting) == nullptr;
}

std::string valueOf(const DeviceState& device, const std::string& setting) {
  const SettingState* state = device.find(setting);
  return state == nullptr ? "" : state->value;
}

/// How many of the projectors that answer are off, on, warming up and cooling down, in the order of the names.
struct PowerCount {
  int off = 0, on = 0, warming = 0, cooling = 0;

  explicit PowerCount(const WallSnapshot& wall) {
    for (const auto& device : wall.devices) {
      if (device->device.isMirror || device->contact != Contact::kWell) continue;
      const std::string value = valueOf(*device, "power");
      if (value == "off") ++off;
      if (value == "on") ++on;
      if (value == "warming") ++warming;
      if (value == "cooling") ++cooling;
    }
  }
  [[nodiscard]] Power power(std::optional<bool> ordered) const {
    if (warming > 0 || (ordered == true && (off > 0 || cooling > 0))) return Power::kWarming;
    if (cooling > 0 || (ordered == false && on > 0)) return Power::kCooling;
    if (on > 0) return Power::kOn;
    return off > 0 ? Power::kOff : Power::kUnknown;
  }
};

int starting(const std::function<int()>& start) {
  try {
    return start();
  } catch (const std::invalid_argument& error) {
    throw RemoteError(Kind::kWrong, error.what());
  } catch (const calib::StoreError& error) {
    throw RemoteError(Kind::kWrong, error.what());
  } catch (const std::runtime_error& error) {
    throw RemoteError(Kind::kNotNow, error.what());
  }
}

}  // namespace

std::string_view nameOf(Power power) {
  constexpr std::array<std::string_view, 5> kNames = {"unknown", "off", "on", "warming", "cooling"};
  return kNames.at(static_cast<std::size_t>(power));
}

WallSummary WallRemote::summary() {
  const auto wall = snapshot();
  const PowerCount count(*wall);
  WallSummary summary;
  summary.power = count.power(ordered("power", *wall));
  summary.partly = count.on > 0 && count.off > 0;
  summary.muted = allHave("mute", *wall);
  summary.frozen = allHave("freeze", *wall);
  summary.preset = presetInPlace(*wall);
  return summary;
}

/// What is still being done.
std::optional<bool> WallRemote::ordered(const std::string& setting, const WallSnapshot& wall) const {
  const auto order = orders_.find(setting);
  if (order == orders_.end()) return std::nullopt;
  const ConsoleJob* job = wall.find(order->second.job);
  return job != nullptr && job->running ? std::optional(order->second.on) : std::nullopt;
}

std::optional<bool> WallRemote::allHave(const std::string& setting, const WallSnapshot& wall) const {
  if (const auto order = ordered(setting, wall)) return order;
  int on = 0;
  int able = 0;
  for (const auto& device : wall.devices) {
    if (device->find(setting) == nullptr || device->contact != Contact::kWell) continue;
    ++able;
    if (valueOf(*device, setting) == "on") ++on;
  }
  return able == 0 ? std::nullopt : std::optional(on == able);
}

const std::string& WallRemote::presetInPlace(const WallSnapshot& wall) {
  const ConsoleJob* job = wall.find(restored_.job);
  const bool failed = job != nullptr && !job->running && !job->error.empty();
  if (failed) restored_ = {.name = restored_.before};
  return restored_.name;
}

int WallRemote::setAll(const std::string& setting, bool on) {
  const auto wall = snapshot();
  if (ordered(setting, *wall) == on) return orders_.at(setting).job;
  std::string names;
  for (const auto& device : wall->devices) {
    if (device->device.isMirror || isKnownToLack(*device, setting)) continue;
    names += (names.empty() ? "" : ",") + device->device.name;
  }
  if (names.empty()) throw RemoteError(Kind::kImpossible, "no projector of this wall has a control with " + setting);
  const int job = device(names, {setting + (on ? "=on" : "=off")});
  orders_[setting] = {job, on};
  return job;
}

int WallRemote::device(const std::string& names, const std::vector<std::string>& steps) {
  return starting([&] { return console_.device(names, steps); });
}

int WallRemote::savePreset(const std::string& name) {
  return starting([&] { return console_.savePreset(name); });
}

/// Asks the files: a snapshot may be seconds old.
void WallRemote::requirePreset(const std::string& name) const {
  std::vector<std::string> names;
  try {
    calib::checkPresetName(name);
    names = calib::presetNames(console_.folder());
  } catch (const calib::StoreError& error) {
    throw RemoteError(Kind::kWrong, error.what());
  }
  if (std::ranges::find(names, name) != names.end()) return;
  std::string list;
  for (const auto& each : names) list += (list.empty() ? "" : ", ") + each;
  throw RemoteError(Kind::kUnknown, "there is no preset \"" + name + "\"; there are " + (list.empty() ? "none" : list));
}

int WallRemote::restorePreset(const std::string& name, bool verify) {
  requirePreset(name);
  const std::string before = presetInPlace(*snapshot());
  const int job = starting([&] { return console_.restorePreset(name, verify); });
  restored_ = {name, job, before};
  return job;
}

int WallRemote::planPreset(const std::string& name) {
  requirePreset(name);
  return starting([&] { return console_.planPreset(name); });
}

int WallRemote::deletePreset(const std::string& name) {
  requirePreset(name);
  return starting([&] { return console_.deletePreset(name); });
}

int WallRemote::calibrate(const std::vector<std::string>& arguments) {
  return starting([&] { return console_.calibrate(arguments); });
}

void WallRemote::cancel(int job) {
  if (snapshot()->find(job) == nullptr) {
    throw RemoteError(Kind::kUnknown, "there is no job " + std::to_string(job) + " (any more)");
  }
  console_.cancel(job);
}

}  // namespace pixelflex::viewer
