#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

using Byte = unsigned char;

constexpr std::chrono::milliseconds kLongestGap{500};
constexpr Byte kPower = 0x11;
constexpr Byte kZoom = 0x12;
constexpr Byte kFocus = 0x13;
constexpr Byte kInput = 0x21;
constexpr Byte kBright = 0x31;
constexpr Byte kContrast = 0x32;
constexpr Byte kRed = 0x3B;
constexpr Byte kBlue = 0x3D;
constexpr Byte kBlank = 0x41;
constexpr int kMost = 0x7F;
constexpr std::array<int, 4> kInputs = {0x11, 0x12, 0x21, 0x22};

class HitachiLegacySimulator : public ProjectorSimulator {
 public:
  HitachiLegacySimulator() { state().input = 0x21; }

  void receive(std::string_view bytes, Time now) override {
    advance(now);
    // A gap inside a command makes it a wrong one.
    if (!typed_.empty() && now - lastByte_ > kLongestGap) fail(now);
    lastByte_ = now;
    typed_ += bytes;
    while (typed_.size() >= 2 && take(now)) {
    }
  }

 private:
  /// One command off the front of what was typed; false while it is not whole.
  bool take(Time now) {
    const Byte first = byteAt(0);
    const Byte item = byteAt(1);
    const std::size_t count = (first >> 4U) == 3 ? first & 15U : 0;
    if (typed_.size() < 2 + count) return false;
    const std::string data = typed_.substr(2, count);
    typed_.erase(0, 2 + count);
    if (suffers(Fault::kBusy)) {
      reply(0, item, data, now);
    } else if (first == 0x20) {
      ask(item, now);
    } else if (count > 0) {
      set(item, data, now);
    } else {
      reply(0, item, "", now);
    }
    return true;
  }

  [[nodiscard]] Byte byteAt(std::size_t i) const { return static_cast<Byte>(typed_[i]); }

  void fail(Time now) {
    reply(0, typed_.size() > 1 ? byteAt(1) : Byte{0}, "", now);
    typed_.clear();
  }

  void reply(int kind, Byte item, const std::string& data, Time at) {
    const int first = kind << 4U | static_cast<int>(data.size());
    say(std::string{static_cast<char>(first), static_cast<char>(item)} + data, at);
  }

  void replyValue(Byte item, int value, Time at) {
    const std::string byte(1, static_cast<char>(value));
    const bool wide = item == kBright || item == kContrast || item == kRed || item == kBlue;
    reply(1, item, (wide ? std::string(2, '\0') : "") + byte, at);
  }

  int* numberOf(Byte item) {
    ProjectorState& its = state();
    switch (item) {
      case kBright:
        return &its.brightness;
      case kContrast:
        return &its.contrast;
      case kRed:
        return &its.gain[0];
      case kBlue:
        return &its.gain[2];
      case kInput:
        return &its.input;
      default:
        return nullptr;
    }
  }

  void ask(Byte item, Time now) {
    if (item == kPower) return replyValue(item, state().isOn() ? 0x1F : 0x1E, now);
    if (item == kBlank) return replyValue(item, state().mute ? 0x10 : 0, now);
    const int* number = numberOf(item);
    if (number == nullptr) return reply(0, item, "", now);
    replyValue(item, *number, now);
  }

  void set(Byte item, const std::string& data, Time now) {
    const int value = static_cast<Byte>(data.back());
    int* number = numberOf(item);
    if (item == kPower && (value == 0x1F || value == 0x1E)) {
      state().setPower(value == 0x1F, now);
      // The reply comes when the lamp has done it.
      return replyValue(item, value, state().isChanging() ? state().powerChangesAt : now);
    }
    if (item == kBlank) {
      state().mute = (value & 0x10) != 0;
    } else if (item == kZoom || item == kFocus) {
      turn(item == kZoom ? state().lens.zoom : state().lens.focus, value);
    } else if (item == kInput && std::ranges::find(kInputs, value) != kInputs.end()) {
      *number = value;
    } else if (number != nullptr && item != kInput) {
      *number = std::min(value, kMost);
      return replyValue(item, *number, now);
    } else {
      return reply(0, item, number == nullptr ? "" : data, now);
    }
    replyValue(item, value, now);
  }

  void turn(ProjectorState::Motor& motor, int value) {
    if (suffers(Fault::kStuck)) return;
    motor.turn((value & 0x40) != 0 ? -(value & 0x3F) : value & 0x3F);
  }

  std::string typed_;
  Time lastByte_{};
};

}  // namespace

std::unique_ptr<ProjectorSimulator> makeHitachiLegacySimulator() {
  return std::make_unique<HitachiLegacySimulator>();
}

}  // namespace pixelflex::devices
