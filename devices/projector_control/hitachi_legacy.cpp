#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include "devices/projector_control/drivers.h"
#include "devices/projector_control/projector_driver.h"

namespace pixelflex::devices {
namespace {

using Byte = unsigned char;
using std::chrono::milliseconds;

// The device takes so long for a byte that is missing in the middle of a command.
constexpr milliseconds kTimeout{1500};
constexpr int kMotorSteps = 255;
constexpr int kMostNudge = 0x3F;
constexpr Byte kAsk = 0x20;
constexpr Byte kSet = 0x30;
constexpr Byte kFramingError = 0x70;
constexpr Byte kPower = 0x11;

struct Item {
  std::string_view name;
  Byte code;
  int dataBytes;
  bool motor = false;
};
// Zoom and focus by their place in the tables of the family; red and blue where a model has them.
constexpr std::array kItems = {Item{"power", kPower, 1},    Item{"input", 0x21, 1},      Item{"mute", 0x41, 1},
                               Item{"brightness", 0x31, 3}, Item{"contrast", 0x32, 3},   Item{"red", 0x3B, 3},
                               Item{"blue", 0x3D, 3},       Item{"zoom", 0x12, 1, true}, Item{"focus", 0x13, 1, true}};

struct Input {
  std::string_view name;
  int code;
};
constexpr std::array kInputs = {Input{"video1", 0x11}, Input{"video2", 0x12}, Input{"rgb1", 0x21}, Input{"rgb2", 0x22}};

const Item& itemOf(const SettingInfo& setting) {
  return *std::ranges::find(kItems, setting.name, &Item::name);
}

/// A reply about `item`, wherever it begins: mouse bytes and what is left of damaged replies come before.
ReplyEnd replyAbout(Byte item) {
  return [item](std::string_view received) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i + 1 < received.size(); ++i) {
      const auto first = static_cast<Byte>(received[i]);
      const auto second = static_cast<Byte>(received[i + 1]);
      const bool framing = first == kFramingError && second == kFramingError;
      if (!framing && (first >= 0x20 || second != item)) continue;
      const std::size_t end = i + 2 + (framing ? 0 : first & 15U);
      if (end <= received.size()) return end;
    }
    return std::nullopt;
  };
}

class HitachiLegacy : public ProjectorDriver {
 public:
  HitachiLegacy(LineLoop& loop, const LineAddress& address, const std::string& name)
      : ProjectorDriver(loop, address, name, {.device = name, .quiet = milliseconds(600)}) {}

 protected:
  std::string doIdentity() override {
    (void)askItem(kPower);
    return "Hitachi two-byte protocol (CP-X955 family, Proxima DP6850)";
  }

  std::vector<SettingInfo> doSettings() override {
    if (!settings_.empty()) return settings_;
    std::vector<SettingInfo> found;
    for (const Item& item : kItems) {
      const std::string name(item.name);
      if (item.motor) {
        found.push_back(motor(name, kMotorSteps));
      } else if (has(item)) {
        found.push_back(describe(item));
      }
    }
    settings_ = std::move(found);
    return settings_;
  }

  SettingValue doRead(const SettingInfo& setting) override {
    const Item& item = itemOf(setting);
    const int value = askItem(item.code);
    if (setting.name == "power") return onOffValue((value & 1) != 0);
    if (setting.name == "mute") return onOffValue((value & 0xF0) != 0);
    if (setting.name != "input") return 1.0 * value;
    const auto input = std::ranges::find(kInputs, value, &Input::code);
    return std::string(input == kInputs.end() ? "other" : input->name);
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    const Item& item = itemOf(setting);
    if (setting.name == "power") return setPower(isOn(value), progress);
    if (setting.name == "mute") return expect(setting, item, isOn(value) ? 0x10 : 0);
    if (setting.name == "input") {
      return expect(setting, item, std::ranges::find(kInputs, std::get<std::string>(value), &Input::name)->code);
    }
    if (!item.motor) return expect(setting, item, wholeNumber(value));
    const auto turn = [&](int steps) { turnMotor(item, steps, progress); };
    countTo(setting, wholeNumber(value), turn, [&] { turn(-(kMotorSteps + kMostNudge)); });
  }

  void doNudge(const SettingInfo& setting, double by, const Progress& progress) override {
    const Item& item = itemOf(setting);
    const int steps = static_cast<int>(by);
    if (item.motor) return turnBy(setting, steps, [&](int count) { turnMotor(item, count, progress); });
    const double now = std::get<double>(doRead(setting));
    expect(setting, item, static_cast<int>(std::clamp(now + steps, setting.minimum, setting.maximum)));
  }

 private:
  static SettingInfo describe(const Item& item) {
    const std::string name(item.name);
    if (name == "power") return onOff(name, true);
    if (name == "mute") return onOff(name);
    if (name != "input") return number(name, 0, 0x7F);
    std::vector<std::string> inputs;
    for (const Input& input : kInputs) inputs.emplace_back(input.name);
    return words(name, std::move(inputs));
  }

  /// The reply's data as one number; nothing when the projector answers with an error.
  std::optional<int> valueOf(const std::string& bytes, Byte code) {
    if (bytes.ends_with("pp")) {
      complain("it cannot read us and has fallen back to 1200 baud, 7N1: set both to the same speed");
    }
    // What came before the reply is not part of it.
    for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
      const auto first = static_cast<Byte>(bytes[i]);
      if (first >= 0x20 || static_cast<Byte>(bytes[i + 1]) != code || i + 2 + (first & 15U) != bytes.size()) continue;
      const bool tells = first > 0x10;  // an error begins with 0, and 10h has no data
      return tells ? std::optional<int>(static_cast<Byte>(bytes.back())) : std::nullopt;
    }
    return std::nullopt;
  }

  bool has(const Item& item) { return valueOf(askTwice(question(item.code)), item.code).has_value(); }

  static Exchange question(Byte code) {
    return {.bytes = {static_cast<char>(kAsk), static_cast<char>(code)}, .end = replyAbout(code), .timeout = kTimeout};
  }

  int askItem(Byte code) {
    const auto value = valueOf(askTwice(question(code)), code);
    if (!value) complain("it does not tell that now: is it busy?");
    return *value;
  }

  static Exchange order(const Item& item, int value) {
    std::string bytes = {static_cast<char>(kSet + item.dataBytes), static_cast<char>(item.code)};
    bytes += std::string(static_cast<std::size_t>(item.dataBytes) - 1, '\0') + static_cast<char>(value);
    return {.bytes = bytes, .end = replyAbout(item.code), .timeout = kTimeout};
  }

  /// The reply says what it has taken, which may be the nearest that it can.
  void expect(const SettingInfo& setting, const Item& item, int value) {
    const auto taken = valueOf(askTwice(order(item, value)), item.code);
    if (!taken) complain("it refuses to change " + setting.name + " now");
    if (*taken != value) {
      complain(setting.name + " is " + std::to_string(*taken) + " now: it does not go to " + std::to_string(value));
    }
  }

  void setPower(bool on, const Progress& progress) {
    // Two generations of models differ in a bit, which the state tells.
    const int generation = askItem(kPower) & 0x20;
    Exchange exchange = order(kItems.front(), 0x1E | generation | (on ? 1 : 0));
    exchange.timeout = kLampTime;
    const std::string reply = askSlowly(exchange, progress, on ? "warming up" : "cooling down");
    if (!valueOf(reply, kPower)) complain(std::string("it refuses to be switched ") + (on ? "on" : "off") + " now");
  }

  void turnMotor(const Item& item, int steps, const Progress& progress) {
    while (steps != 0 && !progress.stop.stop_requested()) {
      const int now = std::clamp(steps, -kMostNudge, kMostNudge);
      steps -= now;
      const Exchange exchange = order(item, now > 0 ? now : 0x40 | -now);
      // Not twice: it would turn twice.
      if (!valueOf(line().ask(exchange), item.code)) complain("it does not turn " + std::string(item.name) + " now");
      progress.tell(std::string(item.name) + " " + std::to_string(std::abs(steps)) + " steps to go");
    }
    if (steps != 0) complain(std::string(item.name) + ": stopped on request");
  }

  std::vector<SettingInfo> settings_;
};

}  // namespace

std::unique_ptr<Device> makeHitachiLegacy(LineLoop& loop, const LineAddress& address, const std::string& name) {
  return std::make_unique<HitachiLegacy>(loop, address, name);
}

}  // namespace pixelflex::devices
