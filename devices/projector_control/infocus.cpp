#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "devices/projector_control/drivers.h"
#include "devices/projector_control/projector_driver.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTimeout{3000};

struct Item {
  std::string_view name;
  std::string_view command;
};
constexpr std::array kItems = {Item{"power", "PWR"},  Item{"input", "SRC"},      Item{"mute", "BLK"},
                               Item{"freeze", "FRZ"}, Item{"brightness", "BRT"}, Item{"contrast", "CON"},
                               Item{"red", "RCG"},    Item{"green", "GCG"},      Item{"blue", "BCG"},
                               Item{"zoom", "ZOM"},   Item{"hours", "LMP"}};

struct Answer {
  int minimum = 0;
  int maximum = 0;
  int value = 0;
};

/// "(96-160,128)".
std::optional<Answer> parseAnswer(std::string_view text) {
  Answer answer;
  const auto take = [&text](int& number, char after) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const auto length = static_cast<std::size_t>(end - text.data());
    if (error != std::errc() || length >= text.size() || text[length] != after) return false;
    text.remove_prefix(length + 1);
    return true;
  };
  const auto begin = text.rfind('(');
  if (begin == std::string_view::npos) return std::nullopt;
  text.remove_prefix(begin + 1);
  if (!take(answer.minimum, '-') || !take(answer.maximum, ',') || !take(answer.value, ')')) return std::nullopt;
  return answer;
}

std::optional<std::size_t> endOfAnswer(std::string_view received) {
  const auto end = received.find_first_of(")?");
  if (end == std::string_view::npos) return std::nullopt;
  return end + 1;
}

class Infocus : public ProjectorDriver {
 public:
  Infocus(LineLoop& loop, const LineAddress& address, const std::string& name, milliseconds gap)
      : ProjectorDriver(loop, address, name, {.device = name, .gap = gap}) {}

 protected:
  std::string doIdentity() override {
    (void)get("PWR");
    return "InFocus (PWR1) protocol";
  }

  /// At three seconds a command a projector is asked only once what it has.
  std::vector<SettingInfo> doSettings() override {
    std::vector<SettingInfo> found;
    for (const Item& item : kItems) {
      if (auto info = doFind(item.name)) found.push_back(std::move(*info));
    }
    return found;
  }

  std::optional<SettingInfo> doFind(std::string_view setting) override {
    const auto item = std::ranges::find(kItems, setting, &Item::name);
    if (item == kItems.end()) return std::nullopt;
    auto known = known_.find(item->name);
    if (known == known_.end()) known = known_.emplace(item->name, question(item->command)).first;
    const std::optional<Answer>& answer = known->second;
    if (!answer) return std::nullopt;
    return describe(*item, *answer);
  }

  SettingValue doRead(const SettingInfo& setting) override {
    const int value = get(commandOf(setting)).value;
    return setting.words ? onOffValue(value != 0) : SettingValue(1.0 * value);
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    const int number = setting.words ? (isOn(value) ? 1 : 0) : wholeNumber(value);
    const auto command = commandOf(setting);
    // Not answered, so asked for afterwards.
    say(command, number);
    if (setting.name == "power") {
      return waitUntil([&] { return get(command).value == number; }, kLampTime, progress,
                       number != 0 ? "warming up" : "cooling down");
    }
    const int now = get(command).value;
    if (now != number) complain(setting.name + " is " + std::to_string(now) + ": it did not take " + textOf(value));
  }

  void doNudge(const SettingInfo& setting, double by, const Progress& progress) override {
    const int steps = static_cast<int>(by);
    if (setting.name != "zoom") {
      const double now = std::get<double>(doRead(setting));
      return doWrite(setting, std::clamp(now + steps, setting.minimum, setting.maximum), progress);
    }
    for (int left = std::abs(steps); left > 0; --left) {
      if (progress.stop.stop_requested()) complain("zoom: stopped on request");
      say("ZOM", steps > 0 ? 1 : 0);
      progress.tell("zoom " + std::to_string(left) + " steps to go");
    }
    // Steps are not answered: this says that it still listens.
    (void)get("ZOM");
  }

 private:
  static std::string_view commandOf(const SettingInfo& setting) {
    return std::ranges::find(kItems, setting.name, &Item::name)->command;
  }

  static SettingInfo describe(const Item& item, const Answer& answer) {
    const std::string name(item.name);
    if (name == "power") return onOff(name, true);
    if (name == "mute" || name == "freeze") return onOff(name);
    if (name == "hours") return reading(name, "h");
    SettingInfo info = number(name, answer.minimum, answer.maximum);
    if (name == "input") info.nudgeable = false;
    if (name == "zoom") {
      // One of two directions is all that can be said, and an end cannot be told.
      info.readable = info.settable = false;
      info.approximate = info.slow = true;
    }
    return info;
  }

  /// Nothing when it does not know the command. A damaged answer is asked for again.
  std::optional<Answer> question(std::string_view command) {
    const std::string text = "(" + std::string(command) + "?)";
    for (int attempt = 1; true; ++attempt) {
      const std::string reply = askTwice({.bytes = text, .end = endOfAnswer, .timeout = kTimeout});
      if (reply.ends_with('?')) return std::nullopt;
      if (const auto answer = parseAnswer(reply)) return answer;
      if (attempt > 1) complain("its answer to " + text + " is none: \"" + reply + "\"");
    }
  }

  Answer get(std::string_view command) {
    const auto answer = question(command);
    if (!answer) complain("it does not know (" + std::string(command) + "?)");
    return *answer;
  }

  void say(std::string_view command, int value) {
    (void)line().ask({.bytes = "(" + std::string(command) + std::to_string(value) + ")"});
  }

  std::map<std::string_view, std::optional<Answer>> known_;
};

}  // namespace

std::unique_ptr<Device> makeInfocus(LineLoop& loop, const LineAddress& address, const std::string& name,
                                    milliseconds gap) {
  return std::make_unique<Infocus>(loop, address, name, gap);
}

}  // namespace pixelflex::devices
