#pragma once

#include <algorithm>
#include <array>
#include <chrono>

namespace pixelflex::devices {

/// What every simulated projector has inside, whatever protocol it speaks.
struct ProjectorState {
  using Time = std::chrono::steady_clock::time_point;
  enum class Power { kOff, kWarming, kOn, kCooling };

  /// A motor that knows its ends but does not tell where it is.
  struct Motor {
    int place = 50;
    int minimum = 0;
    int maximum = 100;
    void turn(int steps) { place = std::clamp(place + steps, minimum, maximum); }
    bool operator==(const Motor&) const = default;
  };
  struct Lens {
    Motor zoom;
    Motor focus;
    Motor shiftH;
    Motor shiftV;
    bool operator==(const Lens&) const = default;
  };

  Power power = Power::kOn;
  Time powerChangesAt{};
  std::chrono::milliseconds warmUp{300};  // real lamps: 30 to 140 s
  std::chrono::milliseconds coolDown{200};
  int input = 0;  // the protocol's own code
  bool mute = false;
  bool freeze = false;
  int brightness = 64;
  int contrast = 64;
  std::array<int, 3> gain{100, 100, 100};  // red, green, blue
  Lens lens;
  std::array<Lens, 3> lensMemory;
  int hours = 1234;

  [[nodiscard]] bool isOn() const { return power == Power::kOn; }
  void setPower(bool on, Time now);
  void advance(Time now);
  /// When the lamp will have done what it is doing.
  [[nodiscard]] bool isChanging() const { return power == Power::kWarming || power == Power::kCooling; }
};

}  // namespace pixelflex::devices
