#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include "devices/projector_control/beef_frame.h"
#include "devices/projector_control/beef_link.h"
#include "devices/projector_control/drivers.h"
#include "devices/projector_control/projector_driver.h"

namespace pixelflex::devices {
namespace {

using Byte = unsigned char;
using Operation = BeefOperation;
using std::chrono::milliseconds;

constexpr milliseconds kGap{40};
constexpr int kMotorSteps = 255;
constexpr char kAcknowledged = 0x06;
constexpr char kNotUnderstood = 0x15;
constexpr char kRefused = 0x1C;
constexpr char kData = 0x1D;
constexpr char kBusy = 0x1F;

enum class Kind { kSwitch, kStepped, kMotor, kInput, kLensMemory, kHours, kErrors };
struct Item {
  std::string_view name;
  std::uint16_t type;
  Kind kind;
};
constexpr std::uint16_t kPower = 0x6000;
constexpr std::uint16_t kHoursHigh = 0x109E;
constexpr std::uint16_t kLensLoad = 0x2408;
constexpr std::array kItems = {Item{"power", kPower, Kind::kSwitch},
                               Item{"input", 0x2000, Kind::kInput},
                               Item{"mute", 0x2405, Kind::kSwitch},
                               Item{"mute", 0x3020, Kind::kSwitch},
                               Item{"freeze", 0x3002, Kind::kSwitch},
                               Item{"brightness", 0x2003, Kind::kStepped},
                               Item{"contrast", 0x2004, Kind::kStepped},
                               Item{"red", 0x30B1, Kind::kStepped},
                               Item{"green", 0x30B2, Kind::kStepped},
                               Item{"blue", 0x30B3, Kind::kStepped},
                               Item{"zoom", 0x2401, Kind::kMotor},
                               Item{"focus", 0x2400, Kind::kMotor},
                               Item{"shift_h", 0x2403, Kind::kMotor},
                               Item{"shift_v", 0x2402, Kind::kMotor},
                               Item{"lens_memory", 0x2407, Kind::kLensMemory},
                               Item{"hours", 0x1090, Kind::kHours},
                               Item{"filter_hours", 0x10A0, Kind::kHours},
                               Item{"errors", 0x6020, Kind::kErrors}};

struct Word {
  int code;
  std::string_view name;
};
constexpr std::array kInputs = {Word{0, "computer1"}, Word{1, "video"},     Word{2, "s-video"},  Word{3, "hdmi"},
                                Word{4, "computer2"}, Word{5, "component"}, Word{7, "bnc"},      Word{9, "dvi-d"},
                                Word{0x0A, "video2"}, Word{0x0B, "lan"},    Word{0x0D, "hdmi2"}, Word{0x11, "hdbaset"}};
constexpr std::array kErrors = {Word{0, "none"},       Word{1, "cover open"},   Word{2, "fan"},      Word{3, "lamp"},
                                Word{4, "too hot"},    Word{5, "airflow"},      Word{7, "too cold"}, Word{8, "filter"},
                                Word{0x0F, "shutter"}, Word{0x10, "lens shift"}};

std::string wordOf(const auto& list, int code) {
  const auto found = std::ranges::find(list, code, &Word::code);
  return found == list.end() ? "code " + std::to_string(code) : std::string(found->name);
}

class HitachiBeef : public ProjectorDriver {
 public:
  HitachiBeef(LineLoop& loop, const LineAddress& address, const std::string& name, const std::string& password)
      : ProjectorDriver(loop, address, name, {.device = name, .idleClose = idleCloseOf(address), .gap = kGap}),
        link_(line(), password),
        hasPassword_(!password.empty()) {}

 protected:
  std::string doIdentity() override {
    (void)get(kPower, "power");
    return "Hitachi BE EF protocol";
  }

  std::vector<SettingInfo> doSettings() override {
    if (!found_.empty()) return found_;
    // In standby it tells nothing else: all may be there.
    const bool on = get(kPower, "power") == 1;
    std::vector<SettingInfo> found;
    for (const Item& item : kItems) {
      const bool twice = std::ranges::find(found, item.name, &SettingInfo::name) != found.end();
      if (twice || (on && item.type != kPower && !has(item))) continue;
      found.push_back(describe(item));
    }
    if (on) {
      found_ = found;
      shutter_ = has(*std::ranges::find(kItems, "mute", &Item::name));
      knowsShutter_ = true;
    }
    return found;
  }

  /// Without asking what else there is.
  std::optional<SettingInfo> doFind(std::string_view setting) override {
    if (!found_.empty()) return ProjectorDriver::doFind(setting);
    const auto item = std::ranges::find(kItems, setting, &Item::name);
    if (item == kItems.end()) return std::nullopt;
    if (setting == "mute" && !knowsShutter_) {
      shutter_ = has(*item);
      knowsShutter_ = true;
    }
    return describe(*item);
  }

  SettingValue doRead(const SettingInfo& setting) override {
    const Item item = itemOf(setting);
    const int value = get(item.type, setting.name);
    switch (item.kind) {
      case Kind::kSwitch:
        if (item.type == kPower && value == 2) return std::string("cooling");
        return onOffValue(value == 1);
      case Kind::kInput:
        return wordOf(kInputs, value);
      case Kind::kErrors:
        return wordOf(kErrors, value);
      case Kind::kLensMemory:
        return value + 1.0;
      case Kind::kHours:
        if (setting.name == "hours") return value + 65536.0 * value2(kHoursHigh);
        return 1.0 * value;
      case Kind::kStepped:
      case Kind::kMotor:
        break;
    }
    return 1.0 * value;
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    const Item item = itemOf(setting);
    if (item.type == kPower) return setPower(isOn(value), progress);
    switch (item.kind) {
      case Kind::kSwitch:
        return order(Operation::kSet, item.type, isOn(value) ? 1 : 0, setting.name);
      case Kind::kInput:
        return order(Operation::kSet, item.type,
                     std::ranges::find(kInputs, std::get<std::string>(value), &Word::name)->code, setting.name);
      case Kind::kLensMemory:
        order(Operation::kSet, item.type, wholeNumber(value) - 1, setting.name);
        return order(Operation::kExecute, kLensLoad, 0, setting.name);
      case Kind::kMotor:
        return countTo(
            setting, wholeNumber(value), [&](int steps) { turn(setting, item, steps, progress); },
            [&] { turn(setting, item, -kMotorSteps, progress); });
      case Kind::kStepped:
        return driveTo(
            setting, wholeNumber(value), [&] { return get(item.type, setting.name); },
            [&](int direction) { step(setting, item, direction); }, progress);
      case Kind::kHours:
      case Kind::kErrors:
        break;
    }
  }

  void doNudge(const SettingInfo& setting, double by, const Progress& progress) override {
    const Item item = itemOf(setting);
    const int steps = static_cast<int>(by);
    if (item.kind == Kind::kMotor) {
      return turnBy(setting, steps, [&](int count) { turn(setting, item, count, progress); });
    }
    const double wanted = std::clamp(get(item.type, setting.name) + 1.0 * steps, setting.minimum, setting.maximum);
    doWrite(setting, wanted, progress);
  }

 private:
  [[nodiscard]] Item itemOf(const SettingInfo& setting) const {
    if (setting.name == "mute" && !shutter_) return {"mute", 0x3020, Kind::kSwitch};
    return *std::ranges::find(kItems, setting.name, &Item::name);
  }

  static SettingInfo describe(const Item& item) {
    const std::string name(item.name);
    switch (item.kind) {
      case Kind::kSwitch:
        return onOff(name, item.type == kPower);
      case Kind::kMotor:
        return motor(name, kMotorSteps);
      case Kind::kHours:
        return reading(name, "h");
      case Kind::kErrors:
        return reading(name, "");
      case Kind::kLensMemory:
        return number(name, 1, 3);
      case Kind::kStepped:
        return number(name, 0, 255);
      case Kind::kInput:
        break;
    }
    std::vector<std::string> inputs;
    for (const Word& input : kInputs) inputs.emplace_back(input.name);
    return words(name, std::move(inputs));
  }

  bool has(const Item& item) {
    // A motor cannot be asked for; models without one refuse to turn it.
    if (item.kind == Kind::kMotor) return true;
    return ask(Operation::kGet, item.type, 0).front() == kData;
  }

  static bool answers(Operation operation, const std::string& reply) {
    return operation == Operation::kGet ? reply.front() != kAcknowledged : reply.front() != kData;
  }

  /// The reply from its first byte on. A frame that arrived damaged is sent again.
  std::string ask(Operation operation, std::uint16_t type, int value) {
    const std::string frame = beefFrame(operation, type, static_cast<std::uint16_t>(value));
    // Steps that may have been made are not made again.
    const bool steps = operation == Operation::kIncrement || operation == Operation::kDecrement;
    for (int attempt = 1; true; ++attempt) {
      std::string reply = link_.ask(frame, !steps);
      const bool again = reply.front() == kNotUnderstood || !answers(operation, reply);
      if (!again) return reply;
      if (attempt > 1) complain("it does not understand: is something wrong with the line?");
    }
  }

  int get(std::uint16_t type, const std::string& what) {
    const std::string reply = ask(Operation::kGet, type, 0);
    if (reply.front() != kData) refused(reply, what);
    return static_cast<Byte>(reply[1]) | static_cast<Byte>(reply[2]) << 8U;
  }

  /// Zero where there is no such value.
  int value2(std::uint16_t type) {
    const std::string reply = ask(Operation::kGet, type, 0);
    if (reply.front() != kData) return 0;
    return static_cast<Byte>(reply[1]) | static_cast<Byte>(reply[2]) << 8U;
  }

  void order(Operation operation, std::uint16_t type, int value, const std::string& what) {
    const std::string reply = ask(operation, type, value);
    if (reply.front() != kAcknowledged) refused(reply, what);
  }

  [[noreturn]] void refused(const std::string& reply, const std::string& what) {
    if (reply.front() == kBusy && reply[1] == 4) {
      complain(hasPassword_ ? "it refuses the password" : "it asks for a password: give control a password_file");
    }
    if (reply.front() == kBusy) complain(what + ": it is busy: try again later");
    complain(what + ": it cannot do that now: is it switched on?");
  }

  void step(const SettingInfo& setting, const Item& item, int direction) {
    const std::string reply = ask(direction > 0 ? Operation::kIncrement : Operation::kDecrement, item.type, 0);
    // At an end it refuses; reading tells where that is.
    if (reply.front() != kAcknowledged && reply.front() != kRefused) refused(reply, setting.name);
  }

  void turn(const SettingInfo& setting, const Item& item, int steps, const Progress& progress) {
    for (int left = std::abs(steps); left > 0; --left) {
      if (progress.stop.stop_requested()) complain(setting.name + ": stopped on request");
      step(setting, item, steps);
      progress.tell(setting.name + " " + std::to_string(left) + " steps to go");
    }
  }

  /// It takes no other commands while the lamp changes.
  void setPower(bool on, const Progress& progress) {
    order(Operation::kSet, kPower, on ? 1 : 0, "power");
    waitUntil([&] { return get(kPower, "power") == (on ? 1 : 0); }, kLampTime, progress,
              on ? "warming up" : "cooling down");
    if (!on) return;
    // It counts as on while it warms up, and is silent meanwhile.
    waitUntil([&] { return get(0x6020, "errors") >= 0; }, kLampTime, progress, "warming up");
  }

  /// Before the projector does it, 30 s after the last command, and a command gets lost.
  static milliseconds idleCloseOf(const LineAddress& address) {
    const bool isNetwork = address.kind == LineKind::kTcp && address.port == BeefLink::kNetworkPort;
    return isNetwork ? milliseconds(20'000) : milliseconds(0);
  }

  BeefLink link_;
  bool hasPassword_;
  std::vector<SettingInfo> found_;
  bool shutter_ = true;
  bool knowsShutter_ = false;
};

}  // namespace

std::unique_ptr<Device> makeHitachiBeef(LineLoop& loop, const LineAddress& address, const std::string& name,
                                        const std::string& password) {
  return std::make_unique<HitachiBeef>(loop, address, name, password);
}

}  // namespace pixelflex::devices
