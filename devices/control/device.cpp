#include "devices/control/device.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pixelflex::devices {

std::optional<SettingInfo> Device::doFind(std::string_view setting) {
  const auto all = doSettings();
  const auto found = std::ranges::find(all, setting, &SettingInfo::name);
  if (found == all.end()) return std::nullopt;
  return *found;
}

SettingInfo Device::find(std::string_view setting) {
  if (auto found = doFind(setting)) return *found;
  std::string list;
  for (const auto& info : doSettings()) list += (list.empty() ? "" : ", ") + info.name;
  throw DeviceError(name_ + " has no setting \"" + std::string(setting) + "\", only " + list);
}

std::string Device::identity() {
  const std::lock_guard lock(mutex_);
  return doIdentity();
}

std::vector<SettingInfo> Device::settings() {
  const std::lock_guard lock(mutex_);
  return doSettings();
}

SettingValue Device::read(std::string_view setting) {
  const std::lock_guard lock(mutex_);
  const SettingInfo info = find(setting);
  if (!info.readable) throw DeviceError(name_ + ": " + info.name + " cannot be read, only set");
  return doRead(info);
}

void Device::write(std::string_view setting, const SettingValue& value, const Progress& progress) {
  writeAll({{std::string(setting), value}}, progress);
}

void Device::writeAll(const std::vector<std::pair<std::string, SettingValue>>& values, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<SettingInfo, SettingValue>> found;
  for (const auto& [setting, value] : values) {
    const SettingInfo info = find(setting);
    if (!info.settable) throw DeviceError(name_ + ": " + info.name + " can only be read");
    try {
      found.emplace_back(info, parseSetting(info, textOf(value)));
    } catch (const std::invalid_argument& error) {
      throw DeviceError(name_ + ": " + error.what());
    }
  }
  doWriteAll(found, progress);
}

void Device::nudge(std::string_view setting, double by, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  const SettingInfo info = find(setting);
  if (!info.nudgeable) throw DeviceError(name_ + ": " + info.name + " cannot be changed by steps");
  doNudge(info, by, progress);
}

std::vector<std::string> Device::actions() {
  const std::lock_guard lock(mutex_);
  return doActions();
}

void Device::act(std::string_view action, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  const auto all = doActions();
  if (std::ranges::find(all, action) == all.end()) {
    throw DeviceError(name_ + " cannot do \"" + std::string(action) + "\"");
  }
  doAct(action, progress);
}

void Device::doNudge(const SettingInfo& /*setting*/, double /*by*/, const Progress& /*progress*/) {
  assert(false);  // a device with settings to nudge says how
}

void Device::doAct(std::string_view /*action*/, const Progress& /*progress*/) {
  assert(false);  // a device with actions says how
}

void Device::doWriteAll(const std::vector<std::pair<SettingInfo, SettingValue>>& values, const Progress& progress) {
  for (const auto& [setting, value] : values) doWrite(setting, value, progress);
}

}  // namespace pixelflex::devices
