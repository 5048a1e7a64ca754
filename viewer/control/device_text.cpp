#include "viewer/control/device_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace pixelflex::viewer {
namespace {

using Row = std::vector<std::string>;

std::string inColumns(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string withUnit(const devices::SettingInfo& info, const std::string& value) {
  if (value.empty()) return "not now";
  return info.unit.empty() ? value : value + " " + info.unit;
}

/// The settings that say most about what a device is doing.
std::string stateOf(const DeviceOutcome& outcome) {
  constexpr std::array<std::string_view, 7> kTelling = {"power", "input", "mute", "hours", "errors", "pan", "tilt"};
  std::string text;
  for (const auto& [info, value] : outcome.values) {
    if (value.empty() || std::ranges::find(kTelling, info.name) == kTelling.end()) continue;
    text += (text.empty() ? "" : ", ") + info.name + " " + withUnit(info, value);
  }
  return text;
}

std::string jsonText(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    std::array<char, 8> code{};
    if (byte < 0x20 || byte == 0x7F) {
      (void)std::snprintf(code.data(), code.size(), "\\u%04x", byte);
      json += code.data();
    } else {
      json += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    }
  }
  return json + '"';
}

std::string valuesJson(const DeviceOutcome& outcome) {
  std::string json;
  for (const auto& [info, value] : outcome.values) {
    const std::string text = value.empty() ? "null" : info.words ? jsonText(value) : value;
    json += (json.empty() ? "" : ", ") + jsonText(info.name) + ": " + text;
  }
  return "{" + json + "}";
}

}  // namespace

std::string deviceTable(const std::vector<DeviceOutcome>& outcomes) {
  std::vector<Row> rows;
  for (const auto& outcome : outcomes) {
    const auto& line = outcome.device.line;
    const std::string state = outcome.error.empty() ? stateOf(outcome) : "ERROR: " + outcome.error;
    rows.push_back({outcome.device.name, line.driver, line.at, state});
  }
  return inColumns(rows);
}

std::string deviceValues(const std::vector<DeviceOutcome>& outcomes) {
  std::vector<Row> rows;
  for (const auto& outcome : outcomes) {
    if (!outcome.error.empty()) continue;
    if (!outcome.identity.empty()) rows.push_back({outcome.device.name, "identity", outcome.identity});
    for (const auto& [info, value] : outcome.values) {
      rows.push_back({outcome.device.name, info.name, withUnit(info, value)});
    }
  }
  return inColumns(rows);
}

std::string deviceJson(const std::vector<DeviceOutcome>& outcomes) {
  std::string json;
  for (const auto& outcome : outcomes) {
    const auto& [name, projector, isMirror, line] = outcome.device;
    const bool ok = outcome.error.empty();
    json += json.empty() ? "[\n" : ",\n";
    json += "  {\"device\": " + jsonText(name) + ", \"driver\": " + jsonText(line.driver) +
            ", \"at\": " + jsonText(line.at) + ", \"ok\": " + (ok ? "true" : "false");
    if (!ok) json += ", \"error\": " + jsonText(outcome.error);
    if (!outcome.identity.empty()) json += ", \"identity\": " + jsonText(outcome.identity);
    json += ", \"values\": " + valuesJson(outcome) + "}";
  }
  return json.empty() ? "[]\n" : json + "\n]\n";
}

}  // namespace pixelflex::viewer
