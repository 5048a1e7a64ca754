#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pixelflex::devices {

/// A number in the setting's unit, or one of its words.
using SettingValue = std::variant<double, std::string>;

/// "12.5" or "on"; numbers with as few digits as give them back.
[[nodiscard]] std::string textOf(const SettingValue& value);

/// What can be done with one setting of one device. A device has no settings that it cannot do anything with.
struct SettingInfo {
  std::string name;                       // "brightness"
  std::string unit = {};                  // "deg", "counts", "h", "degC"; empty for steps and words
  std::vector<std::string> choices = {};  // words that can be set; a device may answer with others
  bool words = false;                     // its values are words
  double minimum = 0;                     // of numbers
  double maximum = 0;
  double step = 1;  // numbers in between are rounded to it
  bool readable = true;
  bool settable = true;
  bool nudgeable = false;    // can be changed by steps
  bool slow = false;         // takes seconds to minutes
  bool approximate = false;  // set by counting steps from an end, because it cannot be read
};

/// "from 0 to 100 %", "on or off".
[[nodiscard]] std::string rangeText(const SettingInfo& info);

/// The value that `text` means for `info`. Throws std::invalid_argument, whose message says what is possible.
[[nodiscard]] SettingValue parseSetting(const SettingInfo& info, std::string_view text);

/// Of something that takes long: hears how far it is, and may stop it.
struct Progress {
  std::stop_token stop = {};
  /// Called now and then with words such as "pan 12.3 of 40 deg", on the thread that waits.
  std::function<void(const std::string& state)> report = {};
  void tell(const std::string& state) const {
    if (report) report(state);
  }
};

}  // namespace pixelflex::devices
