#pragma once

#include <array>
#include <string>

#include "devices/simulate/simulated_device.h"

namespace pixelflex::devices {

/// A Directed Perception pan-tilt unit (PTU-46-17.5, firmware 1.09), after its manual: the ASCII command set with echo,
/// verbose and terse replies, limits, slaved moves, and trapezoidal motion.
class PanTiltSimulator : public SimulatedDevice {
 public:
  enum Axis { kPan = 0, kTilt = 1 };
  struct Options {
    bool lineFeeds = true;  // replies end in CR LF, or in CR alone
    int firstPan = 0;       // positions in counts when it is switched on
    int firstTilt = 0;
    double speedFactor = 1;                  // turns so much faster than it says
    std::chrono::milliseconds tableTime{0};  // what PA, PB and PU take; real units: seconds
    std::string version = "Pan-Tilt Controller v1.09.0b, (C)1996 Directed Perception, Inc., All Rights Reserved";
  };
  struct Motor {
    int minimum = 0;  // counts
    int maximum = 0;
    int target = 0;
    int slaved = 0;  // where it shall go once released
    double position = 0;
    double velocity = 0;  // counts/s, signed
    int speed = 1000;     // counts/s
    int acceleration = 2000;
    int base = 1000;
    int upper = 2902;
    int lower = 31;
    char hold = 'R';
    char move = 'R';
  };

  explicit PanTiltSimulator(Options options);
  PanTiltSimulator() : PanTiltSimulator(Options{}) {}

  void receive(std::string_view bytes, Time now) override;
  void advance(Time now) override;

  /// As of the last advance().
  [[nodiscard]] const Motor& motor(Axis axis) const { return motors_.at(axis); }
  [[nodiscard]] bool isMoving() const;
  /// Switched off and on: everything but the positions is as delivered.
  void powerCycle(Time now);
  /// The head ran into something at `axis`: the unit says so by itself.
  void reportStop(Axis axis, Time now);

 private:
  void execute(const std::string& command, Time now);
  void executeAxis(Axis axis, const std::string& rest, Time now);
  void executeMode(const std::string& command, Time now);
  void queryAxis(Axis axis, char what, Time now);
  void setAxis(Axis axis, char what, int value, Time now);
  void moveTo(Axis axis, int target, Time now);
  void setSpeed(Axis axis, int value, Time now);
  void setPower(Axis axis, char what, char mode, Time now);
  void halt(std::string_view which, Time now);
  void await(Time now);
  void reset(Time now);
  void release();
  void advanceMotor(Motor& motor, double seconds) const;
  [[nodiscard]] double travelTime(const Motor& motor) const;
  void confirm(Time now) { reply("", now); }
  void reply(const std::string& text, Time now);
  void value(const std::string& verbose, const std::string& terse, Time now);
  void refuse(const std::string& text, Time now);
  [[nodiscard]] std::string lineEnd() const { return options_.lineFeeds ? "\r\n" : "\r"; }

  Options options_;
  std::array<Motor, 2> motors_;
  std::string typed_;
  bool echo_ = true;
  bool verbose_ = true;
  bool immediate_ = true;
  bool limits_ = true;
  bool velocityMode_ = false;
  Time now_{};
  Time busyUntil_{};  // awaits or recomputes: what is typed meanwhile is carried out then
  std::deque<std::string> later_;
};

}  // namespace pixelflex::devices
