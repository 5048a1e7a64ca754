#include "viewer/remote/pjlink_wall.h"

#include <algorithm>
#include <array>
#include <exception>

#include "viewer/remote/pjlink_status.h"
#include "viewer/remote/remote_error.h"

namespace pixelflex::viewer {
namespace {

using Power = WallSummary::Power;

const std::string kOk = "OK";
const std::string kUndefined = "ERR1";
const std::string kOutOfParameter = "ERR2";
const std::string kNotNow = "ERR3";

constexpr std::size_t kLongName = 64;
constexpr std::size_t kShortName = 32;
constexpr std::size_t kLongest = 128;

struct Body {
  std::string_view name;
  std::string_view classes;
  std::string_view orders;  // values that it can be set to, apart by blanks; empty: it is only asked
  bool needsPower = false;
};
constexpr std::array kBodies = {
    Body{"POWR", "1", "0 1"}, Body{"INPT", "12", "any", true}, Body{"AVMT", "1", "10 11 30 31", true},
    Body{"ERST", "1", ""},    Body{"LAMP", "1", ""},           Body{"INST", "12", ""},
    Body{"NAME", "1", ""},    Body{"INF1", "1", ""},           Body{"INF2", "1", ""},
    Body{"INFO", "1", ""},    Body{"CLSS", "1", ""},           Body{"SNUM", "2", ""},
    Body{"SVER", "2", ""},    Body{"INNM", "2", ""},           Body{"IRES", "2", "", true},
    Body{"RRES", "2", ""},    Body{"FILT", "2", ""},           Body{"FREZ", "2", "0 1", true}};

bool isAmong(std::string_view values, std::string_view value) {
  const std::string padded = " " + std::string(values) + " ";
  return !value.empty() && value.find(' ') == std::string_view::npos &&
         padded.find(" " + std::string(value) + " ") != std::string::npos;
}

std::string errorOf(RemoteError::Kind kind) {
  if (kind == RemoteError::Kind::kImpossible) return kUndefined;
  return kind == RemoteError::Kind::kNotNow ? kNotNow : kOutOfParameter;
}

}  // namespace

std::string PjlinkWall::answer(char itsClass, std::string_view name, std::string_view value) {
  try {
    return obey(itsClass, name, value);
  } catch (const RemoteError& error) {
    return errorOf(error.kind());
  } catch (const std::exception&) {
    return kNotNow;  // as files that cannot be read
  }
}

std::string PjlinkWall::obey(char itsClass, std::string_view name, std::string_view value) {
  const auto body = std::ranges::find(kBodies, name, &Body::name);
  if (body == kBodies.end() || body->classes.find(itsClass) == std::string_view::npos) return kUndefined;
  if (body->needsPower && isStandingBy()) return kNotNow;
  if (name == "INNM") return value.starts_with('?') ? inputName(value.substr(1)) : kOutOfParameter;
  if (value == "?") return get(itsClass, name);
  if (body->orders != "any" && !isAmong(body->orders, value)) return kOutOfParameter;
  return set(itsClass, name, value);
}

bool PjlinkWall::isStandingBy() const {
  const Power power = remote_.summary().power;
  return power != Power::kOn && power != Power::kUnknown;
}

std::string PjlinkWall::get(char itsClass, std::string_view body) const {
  const auto wall = remote_.snapshot();
  if (body == "POWR") return power();
  if (body == "INPT") return input();
  if (body == "AVMT") return remote_.summary().muted.value_or(false) ? muteForm_ + std::string("1") : "30";
  if (body == "ERST") return pjlinkErrors(*wall, remote_.summary().partly);
  if (body == "LAMP") return pjlinkLamps(*wall);
  if (body == "CLSS") return "2";
  if (body == "NAME") return pjlinkText(identity_.name, kLongName);
  if (body == "INF1") return "PixelFlex";
  if (body == "INF2") return "Wall of " + std::to_string(wall->wall->projectors.size()) + " projectors";
  if (body == "INFO") return "";
  if (body != "INST") return getOfClass2(body);
  std::string codes;
  for (const auto& each : pjlinkInputs(*wall, itsClass)) codes += (codes.empty() ? "" : " ") + each.code;
  return codes;
}

std::string PjlinkWall::getOfClass2(std::string_view body) const {
  if (body == "SNUM") return pjlinkText(identity_.serial, kShortName);
  if (body == "SVER") return pjlinkText(identity_.version, kShortName);
  if (body == "FILT") return pjlinkFilter(*remote_.snapshot());
  if (body == "FREZ") {
    const auto frozen = remote_.summary().frozen;
    return !frozen ? kUndefined : *frozen ? "1" : "0";
  }
  const std::string size = resolution();
  if (!size.empty()) return size;
  return body == "IRES" ? "*" : kNotNow;
}

std::string PjlinkWall::power() const {
  switch (remote_.summary().power) {
    case Power::kOff:
      return "0";
    case Power::kOn:
      return "1";
    case Power::kCooling:
      return "2";
    case Power::kWarming:
      return "3";
    case Power::kUnknown:
      break;
  }
  return kNotNow;
}

std::string PjlinkWall::input() const {
  const std::string preset = remote_.summary().preset;
  for (const auto& each : pjlinkInputs(*remote_.snapshot(), '2')) {
    if (each.preset == preset) return each.code;
  }
  return "51";
}

std::string PjlinkWall::inputName(std::string_view code) const {
  for (const auto& each : pjlinkInputs(*remote_.snapshot(), '2')) {
    if (each.code == code) return each.preset.empty() ? "Desktop" : pjlinkText(each.preset, kLongest);
  }
  return kOutOfParameter;
}

/// Of the desktop; empty before calibration.
std::string PjlinkWall::resolution() const {
  const auto calibration = remote_.snapshot()->calibration;
  if (!calibration || !calibration->display) return {};
  const auto& size = calibration->display->resolution;
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string PjlinkWall::set(char itsClass, std::string_view body, std::string_view value) {
  if (body == "POWR") (void)remote_.setAll("power", value == "1");
  if (body == "FREZ") (void)remote_.setAll("freeze", value == "1");
  if (body == "AVMT") return setMute(value);
  if (body == "INPT") return setInput(itsClass, value);
  return kOk;
}

std::string PjlinkWall::setMute(std::string_view value) {
  (void)remote_.setAll("mute", value[1] == '1');
  muteForm_ = value[0];
  return kOk;
}

std::string PjlinkWall::setInput(char itsClass, std::string_view code) {
  for (const auto& each : pjlinkInputs(*remote_.snapshot(), itsClass)) {
    if (each.code != code) continue;
    if (each.preset.empty()) {
      remote_.leavePreset();
    } else {
      (void)remote_.restorePreset(each.preset, false);
    }
    return kOk;
  }
  return kOutOfParameter;
}

}  // namespace pixelflex::viewer
