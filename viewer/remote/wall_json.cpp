#include "viewer/remote/wall_json.h"

#include <array>
#include <charconv>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

namespace pixelflex::viewer {
namespace {

using Json = nlohmann::ordered_json;

std::string textOf(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Null for what cannot be told now.
Json valueJson(const SettingState& setting) {
  if (setting.value.empty()) return nullptr;
  if (setting.info.words) return setting.value;
  double number = 0;
  const char* end = setting.value.data() + setting.value.size();
  const auto [rest, error] = std::from_chars(setting.value.data(), end, number);
  return error == std::errc() && rest == end ? Json(number) : Json(setting.value);
}

Json settingJson(const SettingState& setting) {
  const auto& info = setting.info;
  Json json = {{"value", valueJson(setting)}};
  if (!info.unit.empty()) json["unit"] = info.unit;
  json["settable"] = info.settable;
  if (info.settable && info.words) json["choices"] = info.choices;
  if (info.settable && !info.words) {
    json["minimum"] = info.minimum;
    json["maximum"] = info.maximum;
    json["step"] = info.step;
  }
  if (info.nudgeable) json["nudgeable"] = true;
  if (info.slow) json["slow"] = true;
  if (info.approximate) json["approximate"] = true;
  return json;
}

Json asJson(const DeviceState& device) {
  constexpr std::array<const char*, 3> kContacts = {"not yet", "well", "lost"};
  Json settings = Json::object();
  for (const auto& setting : device.settings) settings[setting.info.name] = settingJson(setting);
  return {{"name", device.device.name},
          {"projector", device.device.projector},
          {"kind", device.device.isMirror ? "mirror" : "control"},
          {"driver", device.device.line.driver},
          {"at", device.device.line.at},
          {"contact", kContacts.at(static_cast<std::size_t>(device.contact))},
          {"identity", device.identity},
          {"trouble", device.trouble},
          {"doing", device.doing},
          {"waiting", device.waiting},
          {"actions", device.actions},
          {"settings", settings}};
}

Json asJson(const ConsoleJob& job) {
  constexpr std::array<const char*, 3> kKinds = {"device", "preset", "calibration"};
  return {{"job", job.number},      {"kind", kKinds.at(static_cast<std::size_t>(job.kind))},
          {"command", job.command}, {"state", job.running ? "running" : job.error.empty() ? "done" : "failed"},
          {"doing", job.state},     {"part", job.part ? Json(*job.part) : Json()},
          {"said", job.said},       {"error", job.error}};
}

Json presetList(const WallSnapshot& wall) {
  Json list = Json::array();
  for (const auto& preset : wall.presets) {
    list.push_back({{"name", preset.name},
                    {"saved", preset.saved},
                    {"devices", preset.devices},
                    {"calibration", preset.hasCalibration},
                    {"calibration_in_use", preset.calibrationInUse},
                    {"trouble", preset.trouble}});
  }
  return list;
}

Json projectorList(const WallSnapshot& wall) {
  Json list = Json::array();
  for (const auto& projector : wall.wall->projectors) {
    list.push_back(
        {{"name", projector.name}, {"resolution", {projector.resolution.width, projector.resolution.height}}});
  }
  return list;
}

/// Null without a calibration that can be used.
Json calibrationJson(const WallSnapshot& wall, const std::string& calibrated) {
  if (!wall.calibration) return nullptr;
  Json json = {{"written", calibrated}, {"desktop", nullptr}};
  if (const auto& display = wall.calibration->display) {
    json["desktop"] = {display->resolution.width, display->resolution.height};
  }
  return json;
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

std::string isoTime(std::chrono::system_clock::time_point at) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(at);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

std::string stateJson(const WallSnapshot& wall, const WallSummary& summary, const std::string& name,
                      const std::string& calibrated) {
  Json devices = Json::array();
  for (const auto& device : wall.devices) devices.push_back(asJson(*device));
  Json jobs = Json::array();
  for (const auto& job : wall.jobs) jobs.push_back(asJson(job));
  return textOf({{"format", "pixelflex-state"},
                 {"version", 1},
                 {"revision", wall.revision},
                 {"name", name},
                 {"power", nameOf(summary.power)},
                 {"partly", summary.partly},
                 {"muted", orNull(summary.muted)},
                 {"frozen", orNull(summary.frozen)},
                 {"preset", summary.preset.empty() ? Json() : Json(summary.preset)},
                 {"calibration", calibrationJson(wall, calibrated)},
                 {"calibration_trouble", wall.calibrationTrouble},
                 {"projectors", projectorList(wall)},
                 {"presets", presetList(wall)},
                 {"jobs", jobs},
                 {"devices", devices}});
}

std::string deviceJson(const DeviceState& device) {
  return textOf(asJson(device));
}

std::string jobJson(const ConsoleJob& job) {
  return textOf(asJson(job));
}

std::string presetsJson(const WallSnapshot& wall) {
  return textOf(presetList(wall));
}

std::string logJson(const WallSnapshot& wall, std::uint64_t after) {
  constexpr std::array<const char*, 3> kKinds = {"command", "note", "error"};
  Json list = Json::array();
  for (const auto& line : wall.log) {
    if (line->number <= after) continue;
    list.push_back({{"number", line->number},
                    {"at", isoTime(line->at)},
                    {"kind", kKinds.at(static_cast<std::size_t>(line->kind))},
                    {"text", line->text}});
  }
  return textOf(list);
}

std::string errorJson(const std::string& message) {
  return textOf(Json::object({{"error", message}}));
}

}  // namespace pixelflex::viewer
