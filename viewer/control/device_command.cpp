#include "viewer/control/device_command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace pixelflex::viewer {
namespace {

constexpr std::array<std::string_view, 2> kActions = {"home", "reset"};

bool isWord(std::string_view text) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && std::ranges::all_of(text, fits);
}

double numberOf(const std::string& text, const std::string& whole) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
    throw std::invalid_argument("\"" + whole + "\": a number belongs behind += and -=");
  }
  return number;
}

bool isNamed(const calib::WallDevice& device, const std::string& name) {
  return name == "all" || name == device.name || name == device.projector;
}

std::vector<std::string> partsOf(const std::string& names) {
  std::vector<std::string> parts;
  std::istringstream stream(names);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<calib::WallDevice> named(const std::vector<calib::WallDevice>& devices, const std::string& names) {
  const auto parts = partsOf(names);
  for (const auto& part : parts) {
    if (std::ranges::any_of(devices, [&](const auto& device) { return isNamed(device, part); })) continue;
    std::string list;
    for (const auto& device : devices) list += (list.empty() ? "" : ", ") + device.name;
    throw std::invalid_argument("\"" + part + "\" is no device of this wall; there are " + list);
  }
  std::vector<calib::WallDevice> chosen;
  std::ranges::copy_if(devices, std::back_inserter(chosen), [&](const auto& device) {
    return std::ranges::any_of(parts, [&](const auto& part) { return isNamed(device, part); });
  });
  return chosen;
}

}  // namespace

DeviceStep parseDeviceStep(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) {
    if (!isWord(text)) throw std::invalid_argument("\"" + text + "\" is no setting; write SETTING or SETTING=VALUE");
    if (text == "halt") return {.kind = DeviceStep::Kind::kHalt, .name = text};
    const bool acts = std::ranges::find(kActions, text) != kActions.end();
    return {.kind = acts ? DeviceStep::Kind::kAct : DeviceStep::Kind::kRead, .name = text};
  }
  const char sign = equals > 0 ? text[equals - 1] : ' ';
  const bool nudges = sign == '+' || sign == '-';
  const std::string name = text.substr(0, nudges ? equals - 1 : equals);
  const std::string value = text.substr(equals + 1);
  if (!isWord(name) || value.empty()) {
    throw std::invalid_argument("\"" + text + "\": write SETTING=VALUE, SETTING+=STEPS or SETTING-=STEPS");
  }
  if (!nudges) return {.kind = DeviceStep::Kind::kWrite, .name = name, .value = value};
  return {.kind = DeviceStep::Kind::kNudge, .name = name, .by = (sign == '-' ? -1 : 1) * numberOf(value, text)};
}

bool isForMirror(const DeviceStep& step) {
  using Kind = DeviceStep::Kind;
  const std::string& name = step.name;
  return step.kind == Kind::kAct || step.kind == Kind::kHalt || name == "limits" || name == "pan" || name == "tilt" ||
         name.starts_with("pan_") || name.starts_with("tilt_");
}

bool DeviceJob::moves() const {
  using Kind = DeviceStep::Kind;
  return device.isMirror && std::ranges::any_of(steps, [](const DeviceStep& step) {
           return step.kind == Kind::kWrite || step.kind == Kind::kNudge || step.kind == Kind::kAct;
         });
}

std::vector<DeviceJob> planDevices(const std::vector<calib::WallDevice>& devices, const std::string& names,
                                   const std::vector<std::string>& steps) {
  std::vector<DeviceJob> jobs;
  for (const auto& device : named(devices, names)) jobs.push_back({device, {}});
  for (const auto& text : steps) {
    const DeviceStep step = parseDeviceStep(text);
    bool taken = false;
    for (auto& job : jobs) {
      if (job.device.isMirror != isForMirror(step)) continue;
      job.steps.push_back(step);
      taken = true;
    }
    if (taken) continue;
    const std::string what = isForMirror(step) ? "a mirror" : "a projector's control";
    throw std::invalid_argument("\"" + text + "\" is for " + what + ", and " + names + " has none");
  }
  // Who has nothing to do is left alone; without steps all is read.
  if (!steps.empty()) std::erase_if(jobs, [](const DeviceJob& job) { return job.steps.empty(); });
  return jobs;
}

}  // namespace pixelflex::viewer
