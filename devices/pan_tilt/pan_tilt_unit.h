#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "devices/control/device_error.h"
#include "devices/control/setting.h"
#include "devices/transport/line.h"

namespace pixelflex::devices {

enum class PanTiltAxis { kPan = 0, kTilt = 1 };

/// What a unit says about one of its axes. Speeds in counts/s.
struct PanTiltMotor {
  int minimum = 0;  // counts
  int maximum = 0;
  double degreesPerCount = 0;
  int speed = 0;
  int acceleration = 0;  // counts/s²
  int base = 0;
  int upper = 0;
  int lower = 0;
  [[nodiscard]] double degrees(int counts) const { return counts * degreesPerCount; }
  [[nodiscard]] int counts(double degrees) const;
};

/// A Directed Perception (FLIR) pan-tilt unit by its ASCII commands; positive pan is to the left, positive tilt up.
/// One thread at a time, but halt() from any. The modes that it was found in are put back at the end, and it is halted
/// if it still moves then. Throws LineError and DeviceError.
class PanTiltUnit {
 public:
  /// `name` as in LineOptions::device.
  PanTiltUnit(LineLoop& loop, const LineAddress& address, const std::string& name);
  ~PanTiltUnit();
  PanTiltUnit(const PanTiltUnit&) = delete;
  PanTiltUnit& operator=(const PanTiltUnit&) = delete;

  /// Its firmware's own words.
  [[nodiscard]] const std::string& version();
  /// As read when the line was opened, and as set since.
  [[nodiscard]] const PanTiltMotor& motor(PanTiltAxis axis);

  [[nodiscard]] int position(PanTiltAxis axis);  // counts
  /// Where it is going.
  [[nodiscard]] int target(PanTiltAxis axis);
  /// Both axes at once; an axis without a target stays. Returns when it is there. A target outside the unit's limits is
  /// refused before anything moves; an axis that stays behind, or a stop request, halts both.
  void moveTo(std::optional<int> pan, std::optional<int> tilt, const Progress& progress = {});
  void setSpeed(PanTiltAxis axis, int countsPerSecond);
  /// Takes the unit several seconds.
  void setAcceleration(PanTiltAxis axis, int countsPerSecondSquared);
  [[nodiscard]] bool limitsEnabled();
  /// This driver never moves past the limits, whatever the unit itself would allow.
  void setLimitsEnabled(bool enabled);
  /// Runs both axes to their stops and back to 0; up to 30 s.
  void reset(const Progress& progress = {});

  /// At once, before whatever waits or is under way.
  void halt();

 private:
  using Places = std::array<std::optional<int>, 2>;  // counts; none: that axis stays

  void makeReady();
  void learnModes();
  void readMotor(PanTiltAxis axis);
  std::string askTwice(const Exchange& exchange);
  std::string ask(const std::string& command, std::chrono::milliseconds timeout = kUsualTimeout);
  int askNumber(const std::string& command);
  double askReal(const std::string& command);
  void say(const std::string& command) noexcept;
  void checkTarget(PanTiltAxis axis, std::optional<int> target);
  [[nodiscard]] std::optional<Places> look(const Places& target, int& lost);
  void follow(const Places& target, const Progress& progress);
  void haltQuietly() noexcept;
  void complainOfStops() const;
  void complainOfStall(const Places& now, const Places& target) const;
  [[noreturn]] void complain(const std::string& what) const;

  static constexpr std::chrono::milliseconds kUsualTimeout{500};

  std::string name_;
  Line line_;
  std::uint64_t readySession_ = 0;
  std::string version_;
  std::array<PanTiltMotor, 2> motors_;
  bool foundEcho_ = false;
  bool foundVerbose_ = false;
  int panStops_ = 0;
  int tiltStops_ = 0;
  std::atomic<bool> moving_ = false;
  std::atomic<int> halts_ = 0;
  int haltsBefore_ = 0;  // the move that is under way
};

}  // namespace pixelflex::devices
