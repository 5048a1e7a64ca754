#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string>
#include <utility>

#include "devices/projector_control/drivers.h"
#include "devices/projector_control/projector_driver.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTimeout{2000};
constexpr int kMotorSteps = 255;
constexpr int kNetworkPort = 3629;
constexpr std::size_t kHelloSize = 16;

enum class Kind { kPower, kSwitch, kNumber, kMotor, kInput, kLensMemory, kHours, kErrors };
struct Item {
  std::string_view name;
  std::string_view command;
  Kind kind;
};
constexpr std::array kItems = {
    Item{"power", "PWR", Kind::kPower},          Item{"input", "SOURCE", Kind::kInput},
    Item{"mute", "MUTE", Kind::kSwitch},         Item{"freeze", "FREEZE", Kind::kSwitch},
    Item{"brightness", "BRIGHT", Kind::kNumber}, Item{"contrast", "CONTRAST", Kind::kNumber},
    Item{"red", "GAINR", Kind::kNumber},         Item{"green", "GAING", Kind::kNumber},
    Item{"blue", "GAINB", Kind::kNumber},        Item{"zoom", "ZOOM", Kind::kMotor},
    Item{"focus", "FOCUS", Kind::kMotor},        Item{"shift_h", "HLENS", Kind::kMotor},
    Item{"shift_v", "LENS", Kind::kMotor},       Item{"lens_memory", "POPLP", Kind::kLensMemory},
    Item{"hours", "LAMP", Kind::kHours},         Item{"errors", "ERR", Kind::kErrors}};

struct Word {
  int code;
  std::string_view name;
};
constexpr std::array kSources = {Word{0x11, "computer1"}, Word{0x14, "component"}, Word{0x1F, "computer"},
                                 Word{0x30, "hdmi1"},     Word{0x41, "video"},     Word{0x42, "s-video"},
                                 Word{0x52, "usb"},       Word{0x53, "lan"},       Word{0x80, "hdbaset"},
                                 Word{0xA0, "hdmi2"}};
constexpr std::array kErrors = {Word{0, "none"},          Word{1, "fan"},       Word{3, "lamp would not light"},
                                Word{4, "too hot"},       Word{6, "lamp"},      Word{7, "lamp cover open"},
                                Word{8, "cinema filter"}, Word{9, "capacitor"}, Word{0x0A, "iris"},
                                Word{0x0D, "air filter"}};
constexpr std::array kPowerStates = {Word{0, "off"},     Word{1, "on"},  Word{2, "warming"},
                                     Word{3, "cooling"}, Word{4, "off"}, Word{5, "abnormal"}};

std::optional<int> parseHex(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string hexText(int value) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return {kDigits[static_cast<std::size_t>(value) >> 4U & 15U], kDigits[static_cast<std::size_t>(value) & 15U]};
}

std::string wordOf(const auto& list, const std::string& text) {
  const auto code = parseHex(text);
  const auto found = std::ranges::find(list, code.value_or(-1), &Word::code);
  return found == list.end() ? "code " + text : std::string(found->name);
}

const Item& itemOf(const SettingInfo& setting) {
  return *std::ranges::find(kItems, setting.name, &Item::name);
}

class EscVp21 : public ProjectorDriver {
 public:
  EscVp21(LineLoop& loop, const LineAddress& address, const std::string& name)
      : ProjectorDriver(loop, address, name, {.device = name, .resync = "\r"}),
        greets_(address.kind == LineKind::kTcp && address.port == kNetworkPort) {}

 protected:
  std::string doIdentity() override {
    (void)get("PWR");
    return "Epson ESC/VP21";
  }

  std::vector<SettingInfo> doSettings() override {
    if (!found_.empty()) return found_;
    // In standby it tells hardly anything: all may be there.
    const bool on = powerState() == "on";
    std::vector<SettingInfo> found;
    for (const Item& item : kItems) {
      if (!on || has(item)) found.push_back(describe(item));
    }
    if (on) found_ = found;
    return found;
  }

  SettingValue doRead(const SettingInfo& setting) override {
    const Item& item = itemOf(setting);
    if (item.kind == Kind::kPower) return powerState();
    const std::string text = get(item.command);
    if (item.kind == Kind::kSwitch) return onOffValue(text == "ON");
    if (item.kind == Kind::kInput) return wordOf(kSources, text);
    if (item.kind == Kind::kErrors) return wordOf(kErrors, text);
    return 1.0 * numberIn(text, setting.name);
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    const Item& item = itemOf(setting);
    switch (item.kind) {
      case Kind::kPower:
        return setPower(isOn(value), progress);
      case Kind::kSwitch:
        return order(item.command, isOn(value) ? "ON" : "OFF");
      case Kind::kInput:
        return order(item.command,
                     hexText(std::ranges::find(kSources, std::get<std::string>(value), &Word::name)->code));
      case Kind::kNumber:
        return order(item.command, std::to_string(wholeNumber(value)));
      case Kind::kLensMemory:
        return order(item.command, hexText(wholeNumber(value)));
      case Kind::kMotor:
        return countTo(
            setting, wholeNumber(value), [&](int steps) { turn(setting, item, steps, progress); },
            [&] { order(item.command, "MIN"); });
      case Kind::kHours:
      case Kind::kErrors:
        break;
    }
  }

  void doNudge(const SettingInfo& setting, double by, const Progress& progress) override {
    const Item& item = itemOf(setting);
    const int steps = static_cast<int>(by);
    if (item.kind == Kind::kMotor) {
      return turnBy(setting, steps, [&](int count) { turn(setting, item, count, progress); });
    }
    const double now = std::get<double>(doRead(setting));
    doWrite(setting, std::clamp(now + steps, setting.minimum, setting.maximum), progress);
  }

 private:
  static SettingInfo describe(const Item& item) {
    const std::string name(item.name);
    switch (item.kind) {
      case Kind::kPower:
        return onOff(name, true);
      case Kind::kSwitch:
        return onOff(name);
      case Kind::kNumber:
        return number(name, 0, 255);
      case Kind::kMotor:
        return motor(name, kMotorSteps);
      case Kind::kHours:
        return reading(name, "h");
      case Kind::kErrors:
        return reading(name, "");
      case Kind::kLensMemory: {
        SettingInfo info = number(name, 1, 10);
        info.readable = info.nudgeable = false;
        info.slow = true;
        return info;
      }
      case Kind::kInput:
        break;
    }
    std::vector<std::string> sources;
    for (const Word& source : kSources) sources.emplace_back(source.name);
    return words(name, std::move(sources));
  }

  bool has(const Item& item) {
    // What cannot be asked for counts as there.
    if (item.kind == Kind::kMotor || item.kind == Kind::kLensMemory) return true;
    return say(std::string(item.command) + "?").find("ERR\r") == std::string::npos;
  }

  /// A network projector wants to be greeted on each connection.
  void greet() {
    if (!greets_ || (greeted_ != 0 && greeted_ == line().session())) return;
    const std::string hello = std::string("ESC/VP.net\x10\x03\x00\x00\x00\x00", kHelloSize);
    const auto end = [](std::string_view received) -> std::optional<std::size_t> {
      if (received.size() < kHelloSize) return std::nullopt;
      return kHelloSize;
    };
    const std::string reply = line().ask({.bytes = hello, .end = end, .timeout = kTimeout});
    constexpr std::size_t kStatus = 14;
    if (reply[kStatus] != 0x20) complain("it refuses the connection: does it ask for a password?");
    greeted_ = line().session();
  }

  std::string say(const std::string& command, milliseconds timeout = kTimeout) {
    greet();
    return askTwice({.bytes = command + "\r", .end = untilText(":"), .timeout = timeout});
  }

  std::string get(std::string_view command) {
    const std::string head = std::string(command) + "=";
    std::string reply = say(std::string(command) + "?");
    const bool damaged = reply.find(head) == std::string::npos && reply.find("ERR\r") == std::string::npos;
    if (damaged) reply = say(std::string(command) + "?");
    const auto begin = reply.find(head);
    if (begin == std::string::npos) complain(std::string(command) + ": it does not tell that now: is it switched on?");
    reply.erase(0, begin + head.size());
    return reply.substr(0, reply.find('\r'));
  }

  int numberIn(const std::string& text, const std::string& what) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) complain(what + ": its answer \"" + text + "\" is no number");
    return value;
  }

  std::string powerState() { return wordOf(kPowerStates, get("PWR")); }

  void confirm(const std::string& reply, const std::string& command) {
    if (reply.find("ERR\r") != std::string::npos) complain("it refuses \"" + command + "\": is it switched on?");
  }

  void order(std::string_view command, const std::string& value) {
    const std::string text = std::string(command) + " " + value;
    confirm(say(text), text);
  }

  /// Steps that may have been made are not made again.
  void turn(const SettingInfo& setting, const Item& item, int steps, const Progress& progress) {
    const std::string command = std::string(item.command) + (steps > 0 ? " INC" : " DEC");
    greet();
    for (int left = std::abs(steps); left > 0; --left) {
      if (progress.stop.stop_requested()) complain(setting.name + ": stopped on request");
      confirm(line().ask({.bytes = command + "\r", .end = untilText(":"), .timeout = kTimeout}), command);
      progress.tell(setting.name + " " + std::to_string(left) + " steps to go");
    }
  }

  /// The colon comes when the lamp is lit.
  void setPower(bool on, const Progress& progress) {
    const std::string command = on ? "PWR ON" : "PWR OFF";
    const std::string state = on ? "warming up" : "cooling down";
    greet();
    confirm(askSlowly({.bytes = command + "\r", .end = untilText(":"), .timeout = kLampTime}, progress, state),
            command);
    waitUntil([&] { return powerState() == (on ? "on" : "off"); }, kLampTime, progress, state);
  }

  bool greets_;
  std::uint64_t greeted_ = 0;
  std::vector<SettingInfo> found_;
};

}  // namespace

std::unique_ptr<Device> makeEscVp21(LineLoop& loop, const LineAddress& address, const std::string& name) {
  return std::make_unique<EscVp21>(loop, address, name);
}

}  // namespace pixelflex::devices
