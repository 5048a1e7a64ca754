#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

using Power = ProjectorState::Power;

constexpr std::string_view kHello = "ESC/VP.net";
constexpr std::size_t kHelloSize = 16;
constexpr std::size_t kLongest = 80;
constexpr std::array<int, 4> kSources = {0x11, 0x30, 0x41, 0xA0};

std::string twoDigits(int value) {
  std::array<char, 4> text{};
  (void)std::snprintf(text.data(), text.size(), "%02X", static_cast<unsigned>(value) & 255U);
  return text.data();
}

class EscVp21Simulator : public ProjectorSimulator {
 public:
  EscVp21Simulator() { state().input = 0x30; }

  void receive(std::string_view bytes, Time now) override {
    advance(now);
    typed_ += bytes;
    if (typed_.starts_with(kHello)) {
      if (typed_.size() < kHelloSize) return;
      typed_.erase(0, kHelloSize);
      say(std::string(kHello) + std::string("\x10\x03\x00\x00\x20\x00", 6), now);
    }
    for (auto end = typed_.find('\r'); end != std::string::npos; end = typed_.find('\r')) {
      const std::string command = typed_.substr(0, end);
      typed_.erase(0, end + 1);
      obey(command, now);
    }
    if (typed_.size() > kLongest) typed_.clear();
  }

 private:
  void obey(const std::string& command, Time now) {
    if (command.empty()) return say(":", now);
    if (suffers(Fault::kBusy)) return fail(now);
    const auto blank = command.find(' ');
    if (command.ends_with('?')) return get(command.substr(0, command.size() - 1), now);
    if (blank == std::string::npos) return fail(now);
    set(command.substr(0, blank), command.substr(blank + 1), now);
  }

  void fail(Time now) { say("ERR\r:", now); }

  void answer(const std::string& name, const std::string& value, Time now) { say(name + "=" + value + "\r:", now); }

  int* numberOf(const std::string& name) {
    ProjectorState& its = state();
    if (name == "BRIGHT") return &its.brightness;
    if (name == "CONTRAST") return &its.contrast;
    if (name == "GAINR") return its.gain.data();
    if (name == "GAING") return &its.gain[1];
    if (name == "GAINB") return &its.gain[2];
    return nullptr;
  }

  ProjectorState::Motor* motorOf(const std::string& name) {
    ProjectorState::Lens& lens = state().lens;
    if (name == "ZOOM") return &lens.zoom;
    if (name == "FOCUS") return &lens.focus;
    if (name == "LENS") return &lens.shiftV;
    if (name == "HLENS") return &lens.shiftH;
    return nullptr;
  }

  void get(const std::string& name, Time now) {
    if (name == "PWR") {
      const int code = state().isOn()                     ? 1
                       : state().power == Power::kWarming ? 2
                       : state().power == Power::kCooling ? 3
                                                          : 0;
      return answer(name, twoDigits(code), now);
    }
    if (name == "LAMP") return answer(name, std::to_string(state().hours), now);
    if (!state().isOn()) return fail(now);
    if (name == "SOURCE") return answer(name, twoDigits(state().input), now);
    if (name == "MUTE") return answer(name, state().mute ? "ON" : "OFF", now);
    if (name == "ERR") return answer(name, "00", now);
    const int* number = numberOf(name);
    if (number == nullptr) return fail(now);
    answer(name, std::to_string(*number), now);
  }

  void set(const std::string& name, const std::string& value, Time now) {
    if (name == "PWR" && (value == "ON" || value == "OFF")) {
      state().setPower(value == "ON", now);
      return say(":", state().isChanging() ? state().powerChangesAt : now);
    }
    if (!state().isOn() || !change(name, value)) return fail(now);
    say(":", now);
  }

  bool change(const std::string& name, const std::string& value) {
    int number = 0;
    const bool hex = name == "SOURCE";
    const auto parsed = std::from_chars(value.data(), value.data() + value.size(), number, hex ? 16 : 10);
    const bool isNumber = parsed.ec == std::errc() && parsed.ptr == value.data() + value.size();
    if (name == "MUTE" && (value == "ON" || value == "OFF")) {
      state().mute = value == "ON";
    } else if (hex && isNumber && std::ranges::find(kSources, number) != kSources.end()) {
      state().input = number;
    } else if (name == "POPLP" && isNumber && number >= 1 && number <= 3) {
      state().lens = state().lensMemory.at(static_cast<std::size_t>(number - 1));
    } else if (int* its = numberOf(name); its != nullptr && isNumber && number >= 0 && number <= 255) {
      *its = number;
    } else if (auto* motor = motorOf(name)) {
      return turn(*motor, value);
    } else {
      return false;
    }
    return true;
  }

  bool turn(ProjectorState::Motor& motor, const std::string& value) {
    constexpr int kFar = 1000;
    const int steps = value == "INC" ? 1 : value == "DEC" ? -1 : value == "MIN" ? -kFar : value == "MAX" ? kFar : 0;
    if (!suffers(Fault::kStuck)) motor.turn(steps);
    return steps != 0;
  }

  std::string typed_;
};

}  // namespace

std::unique_ptr<ProjectorSimulator> makeEscVp21Simulator() {
  return std::make_unique<EscVp21Simulator>();
}

}  // namespace pixelflex::devices
