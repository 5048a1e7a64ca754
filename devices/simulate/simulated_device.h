#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace pixelflex::devices {

/// What can be ordered to go wrong.
enum class Fault {
  kDrop,    // the first byte of each reply is missing
  kGarble,  // a bit of each reply is wrong; where the protocol has check sums, requests count as wrong too
  kSlow,    // replies come late
  kSilent,  // no replies at all
  kStuck,   // motors do not turn
  kBusy,    // the device is occupied and says so
  kCut,     // the line is interrupted
};

/// "drop" … "cut"; nothing for other words.
[[nodiscard]] std::optional<Fault> faultOfName(std::string_view name);

/// A device's side of a line: real protocol, no input or output of its own, no clock of its own. Not thread-safe.
class SimulatedDevice {
 public:
  using Time = std::chrono::steady_clock::time_point;

  SimulatedDevice() = default;
  virtual ~SimulatedDevice() = default;
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;

  /// Somebody has opened the line: a serial device does not notice.
  virtual void connected(Time /*now*/) {}
  virtual void receive(std::string_view bytes, Time now) = 0;
  /// Motors and lamps go on to `now`; call it before looking at the device's state.
  virtual void advance(Time /*now*/) {}

  /// What has become due by `now`, to be sent.
  [[nodiscard]] std::string take(Time now);
  /// When there will be more to take.
  [[nodiscard]] std::optional<Time> nextDue() const;
  /// The device closes the connection once all is taken, as network projectors do.
  [[nodiscard]] bool wantsClose() const { return wantsClose_ && due_.empty(); }

  /// For the next `times` replies, or until healed.
  void order(Fault fault, int times = kForEver);
  void heal() { fault_.reset(); }
  [[nodiscard]] std::optional<Fault> fault() const { return fault_; }
  [[nodiscard]] bool suffers(Fault fault) const { return fault_ == fault; }
  static constexpr int kForEver = 1 << 30;
  static constexpr std::chrono::milliseconds kSlowness{1500};

 protected:
  /// One reply, as far as faults are concerned.
  void say(std::string bytes, Time at);
  void forgetOutput() { due_.clear(); }
  void setWantsClose(bool wanted) { wantsClose_ = wanted; }

 private:
  struct Due {
    Time at;
    std::string bytes;
  };
  std::deque<Due> due_;  // in the order in which it was said
  std::optional<Fault> fault_;
  int times_ = 0;
  bool wantsClose_ = false;
};

}  // namespace pixelflex::devices
