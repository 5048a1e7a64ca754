#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/control/wall_console.h"

namespace pixelflex::viewer {

/// All projectors taken as one. What has been ordered and is under way counts: who switched the wall on hears that it
/// warms up, also before the first lamp says so.
struct WallSummary {
  enum class Power { kUnknown, kOff, kOn, kWarming, kCooling };
  enum class Trouble { kNone, kWarning, kError };

  Power power = Power::kUnknown;  // on: at least one is, and none is changing
  bool partly = false;            // some are on and some are off
  std::optional<bool> muted;      // all that can be; none: no projector can
  std::optional<bool> frozen;     // likewise
  std::string preset;             // the last one restored from here; empty: none
};

[[nodiscard]] std::string_view nameOf(WallSummary::Power power);

/// A wall's console as remote controls use it: the whole wall with one order. One thread uses it.
class WallRemote {
 public:
  /// `console` must outlive it.
  explicit WallRemote(WallConsole& console) : console_(console) {}

  [[nodiscard]] WallConsole& console() { return console_; }
  [[nodiscard]] std::shared_ptr<const WallSnapshot> snapshot() const { return console_.snapshot(); }
  [[nodiscard]] WallSummary summary();

  // Each returns the number of its job, and throws RemoteError.

  /// "power", "mute" or "freeze" of all projectors that have it. The same order again while it is under way is the same
  /// job.
  int setAll(const std::string& setting, bool on);
  int device(const std::string& names, const std::vector<std::string>& steps);
  int halt() { return console_.stopAll(); }
  int savePreset(const std::string& name);
  int restorePreset(const std::string& name, bool verify);
  /// The wall counts as set by hand again; nothing is done.
  void leavePreset() { restored_ = {}; }
  int planPreset(const std::string& name);
  int deletePreset(const std::string& name);
  int calibrate(const std::vector<std::string>& arguments);
  /// Throws RemoteError for one that there is not.
  void cancel(int job);

 private:
  struct Order {
    int job = 0;
    bool on = false;
  };
  struct Restored {
    std::string name;
    int job = 0;
    std::string before;
  };
  [[nodiscard]] std::optional<bool> ordered(const std::string& setting, const WallSnapshot& wall) const;
  [[nodiscard]] std::optional<bool> allHave(const std::string& setting, const WallSnapshot& wall) const;
  [[nodiscard]] const std::string& presetInPlace(const WallSnapshot& wall);
  void requirePreset(const std::string& name) const;

  WallConsole& console_;
  std::map<std::string, Order> orders_;  // by setting
  Restored restored_;
};

}  // namespace pixelflex::viewer
