#include "viewer/remote/pjlink_status.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string_view>

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMostLamps = 8;
constexpr std::string_view kNone = "ERR1";
constexpr std::string_view kPresetCodes = "123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::size_t kCodesOfClass1 = 9;

enum Part : std::size_t { kFan, kLamp, kTemperature, kCover, kFilter, kOther, kParts };

struct Clue {
  std::string_view word;
  Part part;
};
// As drivers say it; the first that fits: a lamp's cover is a cover.
constexpr std::array kClues = {Clue{"cover", kCover},      Clue{"fan", kFan},         Clue{"airflow", kFan},
                               Clue{"filter", kFilter},    Clue{"lamp", kLamp},       Clue{"hot", kTemperature},
                               Clue{"cold", kTemperature}, Clue{"temp", kTemperature}};

Part partOf(std::string_view trouble) {
  for (const auto& [word, part] : kClues) {
    if (trouble.find(word) != std::string_view::npos) return part;
  }
  return kOther;
}

/// "fan warning, lamp error"
void addTroubles(const std::string& troubles, std::array<int, kParts>& worst) {
  std::istringstream stream(troubles == "none" ? "" : troubles);
  for (std::string trouble; std::getline(stream, trouble, ',');) {
    int& place = worst.at(partOf(trouble));
    place = std::max(place, trouble.find("warning") != std::string::npos ? 1 : 2);
  }
}

int hoursIn(const SettingState* setting) {
  int hours = 0;
  if (setting != nullptr) std::from_chars(setting->value.data(), setting->value.data() + setting->value.size(), hours);
  return hours;
}

bool tells(const DeviceState& device, const std::string& setting) {
  const SettingState* state = device.find(setting);
  return state != nullptr && !state->value.empty();
}

}  // namespace

std::string pjlinkErrors(const WallSnapshot& wall, bool partlyOn) {
  std::array<int, kParts> worst{};
  if (partlyOn) worst[kOther] = 1;
  for (const auto& device : wall.devices) {
    const bool lost = device->contact == DeviceState::Contact::kLost;
    if (lost) worst[kOther] = std::max(worst[kOther], device->device.isMirror ? 1 : 2);
    if (!lost && tells(*device, "errors")) addTroubles(device->find("errors")->value, worst);
  }
  std::string digits;
  for (const int place : worst) digits += static_cast<char>('0' + place);
  return digits;
}

std::string pjlinkLamps(const WallSnapshot& wall) {
  std::vector<std::pair<int, bool>> lamps;
  for (const auto& device : wall.devices) {
    if (!tells(*device, "hours")) continue;
    const SettingState* power = device->find("power");
    lamps.emplace_back(hoursIn(device->find("hours")), power != nullptr && power->value == "on");
  }
  if (lamps.empty()) return std::string(kNone);
  if (lamps.size() > kMostLamps) {
    std::ranges::stable_sort(lamps, std::greater(), &std::pair<int, bool>::first);
    lamps.resize(kMostLamps);
  }
  std::string text;
  for (const auto& [hours, lit] : lamps) {
    text += (text.empty() ? "" : " ") + std::to_string(std::clamp(hours, 0, 99999)) + (lit ? " 1" : " 0");
  }
  return text;
}

std::string pjlinkFilter(const WallSnapshot& wall) {
  int most = -1;
  for (const auto& device : wall.devices) {
    if (tells(*device, "filter_hours")) most = std::max(most, hoursIn(device->find("filter_hours")));
  }
  return most < 0 ? std::string(kNone) : std::to_string(std::min(most, 99999));
}

std::vector<PjlinkInput> pjlinkInputs(const WallSnapshot& wall, char itsClass) {
  const std::size_t most = itsClass == '1' ? kCodesOfClass1 : kPresetCodes.size();
  std::vector<PjlinkInput> inputs;
  for (const auto& preset : wall.presets) {
    if (inputs.size() == most) break;
    if (preset.trouble.empty()) inputs.push_back({std::string("4") + kPresetCodes[inputs.size()], preset.name});
  }
  inputs.push_back({"51", ""});
  return inputs;
}

std::string pjlinkText(const std::string& text, std::size_t longest) {
  std::size_t end = std::min(text.size(), longest);
  const auto isInside = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
  while (end > 0 && end < text.size() && isInside(end)) --end;
  std::string plain = text.substr(0, end);
  for (char& letter : plain) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 0x20 || byte == 0x7F) letter = ' ';
  }
  return plain;
}

}  // namespace pixelflex::viewer
