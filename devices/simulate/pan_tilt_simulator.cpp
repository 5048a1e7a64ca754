#include "devices/simulate/pan_tilt_simulator.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace pixelflex::devices {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using Motor = PanTiltSimulator::Motor;

constexpr std::size_t kLongestCommand = 100;
constexpr double kMostSeconds = 3600;

const char* nameOf(PanTiltSimulator::Axis axis) {
  return axis == PanTiltSimulator::kPan ? "Pan" : "Tilt";
}

std::optional<int> numberOf(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

const char* powerName(char mode) {
  return mode == 'R' ? "REGULAR" : mode == 'L' ? "LOW" : mode == 'H' ? "HIGH" : "OFF";
}

}  // namespace

PanTiltSimulator::PanTiltSimulator(Options options) : options_(std::move(options)) {
  motors_[kPan].minimum = -3090;
  motors_[kPan].maximum = 3090;
  motors_[kTilt].minimum = -907;
  motors_[kTilt].maximum = 604;
  motors_[kPan].position = motors_[kPan].target = motors_[kPan].slaved = options_.firstPan;
  motors_[kTilt].position = motors_[kTilt].target = motors_[kTilt].slaved = options_.firstTilt;
}

bool PanTiltSimulator::isMoving() const {
  return std::ranges::any_of(motors_, [](const Motor& motor) { return motor.position != motor.target; });
}

void PanTiltSimulator::powerCycle(Time now) {
  advance(now);
  for (Motor& motor : motors_) {
    const int stopped = static_cast<int>(std::lround(motor.position));
    motor = Motor{.minimum = motor.minimum, .maximum = motor.maximum, .target = stopped, .slaved = stopped};
    motor.position = stopped;
  }
  echo_ = verbose_ = immediate_ = limits_ = true;
  velocityMode_ = false;
  typed_.clear();
  later_.clear();
  busyUntil_ = {};
  forgetOutput();
}

void PanTiltSimulator::reportStop(Axis axis, Time now) {
  say(axis == kPan ? "!P" : "!T", now);
}

void PanTiltSimulator::receive(std::string_view bytes, Time now) {
  advance(now);
  for (const char byte : bytes) {
    if (echo_) say(std::string(1, byte), now);
    const bool ends = byte == ' ' || byte == '\r' || byte == '\n';
    if (!ends && typed_.size() < kLongestCommand) {
      typed_ += byte >= 'a' && byte <= 'z' ? static_cast<char>(byte - 'a' + 'A') : byte;
    }
    if (!ends || typed_.empty()) continue;
    later_.push_back(std::exchange(typed_, {}));
    while (!later_.empty() && busyUntil_ <= now) {
      const std::string command = std::move(later_.front());
      later_.pop_front();
      execute(command, now);
    }
  }
}

void PanTiltSimulator::advance(Time now) {
  if (now_ == Time()) now_ = now;
  while (!later_.empty() && busyUntil_ <= now) {
    const Time then = std::max(busyUntil_, now_);
    const std::string command = std::move(later_.front());
    later_.pop_front();
    for (Motor& motor : motors_) advanceMotor(motor, duration<double>(then - now_).count());
    now_ = then;
    execute(command, then);
  }
  if (now <= now_) return;
  for (Motor& motor : motors_) advanceMotor(motor, duration<double>(now - now_).count());
  now_ = now;
}

/// In steps short enough for the ramps to be ramps.
void PanTiltSimulator::advanceMotor(Motor& motor, double seconds) const {
  if (suffers(Fault::kStuck)) {
    motor.velocity = 0;
    return;
  }
  constexpr double kStep = 0.002;
  double rest = std::min(seconds, kMostSeconds) * options_.speedFactor;
  while (rest > 0 && motor.position != motor.target) {
    const double step = std::min(rest, kStep);
    rest -= step;
    const double way = motor.target - motor.position;
    // As fast as still lets it brake down to the base speed.
    const double brake = std::sqrt(motor.base * motor.base + 2.0 * motor.acceleration * std::abs(way));
    const double ramp = std::max(std::abs(motor.velocity) + motor.acceleration * step, 1.0 * motor.base);
    const double speed = std::min({1.0 * motor.speed, brake, ramp});
    motor.velocity = std::copysign(speed, way);
    motor.position = std::abs(way) <= speed * step ? motor.target : motor.position + motor.velocity * step;
  }
  if (motor.position == motor.target) motor.velocity = 0;
}

double PanTiltSimulator::travelTime(const Motor& motor) const {
  Motor copy = motor;
  constexpr double kStep = 0.01;
  double seconds = 0;
  while (copy.position != copy.target && seconds < kMostSeconds && !suffers(Fault::kStuck)) {
    advanceMotor(copy, kStep);
    seconds += kStep;
  }
  return copy.position == copy.target ? seconds : kMostSeconds;
}

void PanTiltSimulator::reply(const std::string& text, Time now) {
  say("*" + (text.empty() ? "" : " " + text) + lineEnd(), std::max(now, busyUntil_));
}

void PanTiltSimulator::value(const std::string& verbose, const std::string& terse, Time now) {
  reply(verbose_ ? verbose : terse, now);
}

void PanTiltSimulator::refuse(const std::string& text, Time now) {
  say("! " + text + lineEnd(), now);
}

void PanTiltSimulator::execute(const std::string& command, Time now) {
  const char first = command.front();
  if ((first == 'P' || first == 'T') && command.size() > 1) {
    return executeAxis(first == 'P' ? kPan : kTilt, command.substr(1), now);
  }
  executeMode(command, now);
}

void PanTiltSimulator::executeAxis(Axis axis, const std::string& rest, Time now) {
  const char what = rest.front();
  const std::string argument = rest.substr(1);
  if (argument.empty()) return queryAxis(axis, what, now);
  if (what == 'H' || what == 'M') return setPower(axis, what, argument.front(), now);
  const auto number = numberOf(argument);
  if (!number) return refuse("Illegal argument", now);
  setAxis(axis, what, *number, now);
}

void PanTiltSimulator::queryAxis(Axis axis, char what, Time now) {
  const Motor& motor = motors_.at(axis);
  const std::string name = nameOf(axis);
  const auto say = [&](const std::string& before, int number, const std::string& after = "") {
    value(before + std::to_string(number) + after, std::to_string(number), now);
  };
  switch (what) {
    case 'P':
      return say("Current " + name + " position is ", static_cast<int>(std::lround(motor.position)));
    case 'O':
      return say("Target " + name + " position is ", immediate_ ? motor.target : motor.slaved);
    case 'R':
      return value("185.1428 seconds arc per position", "185.1428", now);
    case 'N':
      return say("Minimum " + name + " position is ", motor.minimum);
    case 'X':
      return say("Maximum " + name + " position is ", motor.maximum);
    case 'S':
      return say("Target " + name + " speed is ", motor.speed, " positions/sec");
    case 'D':
      return say("Current " + name + " speed is ", static_cast<int>(motor.velocity), " positions/sec");
    case 'A':
      return say(name + " acceleration is ", motor.acceleration, " positions/sec^2");
    case 'B':
      return say("Current " + name + " base speed is ", motor.base, " positions/sec");
    case 'U':
      return say("Maximum " + name + " speed is ", motor.upper, " positions/sec");
    case 'L':
      return say("Minimum " + name + " speed is ", motor.lower, " positions/sec");
    case 'H':
      return value(name + " in " + powerName(motor.hold) + " hold power mode", powerName(motor.hold), now);
    case 'M':
      return value(name + " in " + powerName(motor.move) + " move power mode", powerName(motor.move), now);
    default:
      return refuse("Illegal command", now);
  }
}

void PanTiltSimulator::setAxis(Axis axis, char what, int number, Time now) {
  Motor& motor = motors_.at(axis);
  switch (what) {
    case 'P':
      return moveTo(axis, number, now);
    case 'O':
      return moveTo(axis, static_cast<int>(std::lround(motor.position)) + number, now);
    case 'S':
      return setSpeed(axis, number, now);
    case 'D':
      return setSpeed(axis, motor.speed + number, now);
    case 'L':
      if (number < 31) return refuse("Motor speed cannot be less than 31 pos/sec", now);
      motor.lower = number;
      return confirm(now);
    case 'A':
    case 'B':
    case 'U':
      if (number < 1 || number > 50000) return refuse("Illegal argument", now);
      (what == 'A' ? motor.acceleration : what == 'B' ? motor.base : motor.upper) = number;
      // The tables of the ramps are made anew.
      busyUntil_ = now + options_.tableTime;
      return confirm(now);
    default:
      return refuse("Illegal command", now);
  }
}

void PanTiltSimulator::moveTo(Axis axis, int target, Time now) {
  Motor& motor = motors_.at(axis);
  const std::string name = nameOf(axis);
  if (limits_ && target > motor.maximum) {
    return refuse("Maximum allowable " + name + " position is " + std::to_string(motor.maximum), now);
  }
  if (limits_ && target < motor.minimum) {
    return refuse("Minimum allowable " + name + " position is " + std::to_string(motor.minimum), now);
  }
  motor.slaved = target;
  if (immediate_) motor.target = target;
  confirm(now);
}

void PanTiltSimulator::setSpeed(Axis axis, int number, Time now) {
  Motor& motor = motors_.at(axis);
  if (number > motor.upper) {
    const std::string most = std::to_string(motor.upper);
    return refuse(std::string(nameOf(axis)) + " speed cannot exceed " + most + " positions/sec", now);
  }
  if (number < motor.lower) {
    return refuse("Motor speed cannot be less than " + std::to_string(motor.lower) + " pos/sec", now);
  }
  motor.speed = number;
  confirm(now);
}

void PanTiltSimulator::setPower(Axis axis, char what, char mode, Time now) {
  const std::string_view known = what == 'H' ? "RLO" : "HRL";
  if (known.find(mode) == std::string_view::npos) return refuse("Illegal argument", now);
  (what == 'H' ? motors_.at(axis).hold : motors_.at(axis).move) = mode;
  confirm(now);
}

void PanTiltSimulator::executeMode(const std::string& command, Time now) {
  if (command == "H" || command == "HP" || command == "HT") return halt(command.substr(1), now);
  if (command == "R") return reset(now);
  if (command == "A") return await(now);
  if (command == "I") release();
  if (command == "S" || command == "I") immediate_ = command == "I";
  if (command == "LE" || command == "LD") limits_ = command == "LE";
  if (command == "EE" || command == "ED") echo_ = command == "EE";
  if (command == "FV" || command == "FT") verbose_ = command == "FV";
  if (command == "CI" || command == "CV") velocityMode_ = command == "CV";
  constexpr std::array kSettings = {"S",  "I",  "LE", "LD", "EE", "ED", "FV", "FT", "CI",
                                    "CV", "RE", "RD", "RP", "RT", "DS", "DR", "DF"};
  if (std::ranges::find(kSettings, command) != kSettings.end()) return confirm(now);
  if (command == "V") return reply(options_.version, now);
  if (command == "E") return value(echo_ ? "Echoing ON" : "Echoing OFF", echo_ ? "ON" : "OFF", now);
  if (command == "F") return reply(verbose_ ? "ASCII verbose mode" : "ASCII terse mode", now);
  if (command == "C") return reply(velocityMode_ ? "Pure velocity mode" : "Independent control mode", now);
  if (command == "L") {
    return reply(limits_ ? "Limit bounds are ENABLED (soft limits enabled)"
                         : "Limit bounds are DISABLED (hard limits only: use care)",
                 now);
  }
  refuse("Illegal command", now);
}

void PanTiltSimulator::halt(std::string_view which, Time now) {
  for (const Axis axis : {kPan, kTilt}) {
    if (!which.empty() && which != (axis == kPan ? "P" : "T")) continue;
    Motor& motor = motors_.at(axis);
    motor.position = std::round(motor.position);
    motor.target = motor.slaved = static_cast<int>(motor.position);
    motor.velocity = 0;
  }
  confirm(now);
}

/// Slaved moves begin.
void PanTiltSimulator::release() {
  if (immediate_) return;
  for (Motor& motor : motors_) motor.target = motor.slaved;
}

void PanTiltSimulator::await(Time now) {
  release();
  const double seconds = std::max(travelTime(motors_[kPan]), travelTime(motors_[kTilt]));
  busyUntil_ = now + duration_cast<Time::duration>(duration<double>(seconds));
  confirm(now);
}

/// Both axes run to their stops, which the unit reports as it meets them, and back to zero.
void PanTiltSimulator::reset(Time now) {
  for (Motor& motor : motors_) {
    motor.position = 0;
    motor.target = motor.slaved = 0;
    motor.velocity = 0;
  }
  const auto takes = std::chrono::milliseconds(2000);
  busyUntil_ = now + duration_cast<Time::duration>(takes / options_.speedFactor);
  say("!T!T!P!P*" + lineEnd(), busyUntil_);
}

}  // namespace pixelflex::devices
