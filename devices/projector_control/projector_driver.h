#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "devices/control/device.h"
#include "devices/transport/line.h"

namespace pixelflex::devices {

/// What drivers of projectors share: asking with one repetition, waiting for lamps, turning what can only be turned by
/// steps. Settings have the same names in all of them: power, input, mute (the picture), freeze, brightness, contrast,
/// red, green, blue, zoom, focus, shift_h, shift_v, lens_memory, hours, filter_hours, errors.
class ProjectorDriver : public Device {
 public:
  ProjectorDriver(LineLoop& loop, const LineAddress& address, const std::string& name, LineOptions options);

 protected:
  [[nodiscard]] Line& line() { return line_; }
  /// Once more when a reply got lost: only for what may be done twice.
  std::string askTwice(const Exchange& exchange);
  /// For replies that take minutes: tells `state` with the seconds gone; gives up on a stop request.
  std::string askSlowly(const Exchange& exchange, const Progress& progress, const std::string& state);
  /// Asks until it is so. Lost replies and refusals meanwhile are part of the change.
  void waitUntil(const std::function<bool()>& reached, std::chrono::milliseconds timeout, const Progress& progress,
                 const std::string& state);
  [[noreturn]] void complain(const std::string& what) const;

  /// A number that can be read and changed by one up or down: read and step until it is there. Complains when it stays.
  void driveTo(const SettingInfo& setting, int target, const std::function<int()>& read,
               const std::function<void(int direction)>& step, const Progress& progress);

  /// A motor that cannot be read: from its lower end, counting steps; without going there when it is known where it is.
  void countTo(const SettingInfo& setting, int target, const std::function<void(int steps)>& turn,
               const std::function<void()>& toLowerEnd);
  /// By steps, counting.
  void turnBy(const SettingInfo& setting, int steps, const std::function<void(int steps)>& turn);

  [[nodiscard]] static SettingInfo onOff(const std::string& name, bool slow = false);
  [[nodiscard]] static SettingInfo number(const std::string& name, int minimum, int maximum);
  [[nodiscard]] static SettingInfo motor(const std::string& name, int steps);
  [[nodiscard]] static SettingInfo reading(const std::string& name, const std::string& unit);
  [[nodiscard]] static SettingInfo words(const std::string& name, std::vector<std::string> choices);
  /// "on" means true.
  [[nodiscard]] static bool isOn(const SettingValue& value) { return std::get<std::string>(value) == "on"; }
  [[nodiscard]] static int wholeNumber(const SettingValue& value);
  [[nodiscard]] static SettingValue onOffValue(bool on) { return std::string(on ? "on" : "off"); }

  static constexpr std::chrono::seconds kLampTime{150};

 private:
  Line line_;
  std::map<std::string, int> places_;  // of motors, in steps from their lower ends
};

}  // namespace pixelflex::devices
