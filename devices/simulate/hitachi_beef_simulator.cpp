#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

using Byte = unsigned char;

constexpr std::size_t kFrame = 13;
// As a manual's example has it.
constexpr std::string_view kRandom = "a572f60c";
constexpr std::string_view kHead = "\xBE\xEF";
constexpr int kMost = 255;
enum Operation { kSet = 1, kGet = 2, kIncrement = 4, kDecrement = 5, kExecute = 6 };

/// CRC-16/MODBUS by the definition, bit by bit.
unsigned checkSum(const std::string& frame) {
  unsigned remainder = 0xFFFF;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    remainder ^= i == 5 || i == 6 ? 0U : static_cast<Byte>(frame[i]);
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder & 1U) != 0 ? remainder >> 1U ^ 0xA001U : remainder >> 1U;
  }
  return remainder;
}

class HitachiBeefSimulator : public ProjectorSimulator {
 public:
  explicit HitachiBeefSimulator(HitachiBeefSimulatorOptions options) : options_(std::move(options)) {
    state().input = 3;
  }

  void connected(Time now) override {
    typed_.clear();
    forgetOutput();
    isIn_ = options_.password.empty();
    if (!isIn_) say(std::string(kRandom), now);
  }

  void receive(std::string_view bytes, Time now) override {
    advance(now);
    typed_ += bytes;
    if (options_.network) return receiveWrapped(now);
    while (!typed_.empty()) {
      const auto head = typed_.find(kHead);
      if (head == std::string::npos) {
        typed_.erase(0, typed_.back() == kHead[0] ? typed_.size() - 1 : typed_.size());
        return;
      }
      typed_.erase(0, head);
      if (typed_.size() < kFrame) return;
      const std::string frame = typed_.substr(0, kFrame);
      typed_.erase(0, kFrame);
      obey(frame, now);
    }
  }

 private:
  static int word(const std::string& frame, std::size_t at) {
    return static_cast<Byte>(frame[at]) | static_cast<Byte>(frame[at + 1]) << 8U;
  }

  void obey(const std::string& frame, Time now) {
    const unsigned sum = checkSum(frame);
    const bool sound = static_cast<Byte>(frame[5]) == sum >> 8U && static_cast<Byte>(frame[6]) == (sum & 255U);
    if (!sound || suffers(Fault::kGarble)) return reply("\x15", now);
    if (suffers(Fault::kBusy)) return reply(std::string("\x1F\x01\x00", 3), now);
    const int operation = word(frame, 7);
    const int type = word(frame, 9);
    if (type == 0x6000) return power(operation, word(frame, 11), now);
    // Nothing is heard while the lamp changes; in standby only the power.
    if (state().isChanging()) return;
    if (!state().isOn() && type != 0x6020) return refuse(now);
    if (operation == kGet) return get(type, now);
    change(operation, type, word(frame, 11), now);
  }

  /// 02 0D, a frame, a check sum, a number; before the first of them a digest where one is asked for.
  void receiveWrapped(Time now) {
    constexpr std::size_t kDigest = 32;
    constexpr std::size_t kWrapped = kFrame + 4;
    while (true) {
      const bool hasDigest = !isIn_ && !typed_.empty() && typed_[0] != '\x02';
      const std::size_t skip = hasDigest ? kDigest : 0;
      if (typed_.size() < skip + kWrapped) return;
      if (hasDigest) isIn_ = typed_.substr(0, kDigest) == digestOf(std::string(kRandom) + options_.password);
      const std::string packet = typed_.substr(skip, kWrapped);
      typed_.erase(0, skip + kWrapped);
      number_ = packet.back();
      unsigned sum = 0;
      for (std::size_t i = 0; i + 1 < packet.size(); ++i) sum += static_cast<Byte>(packet[i]);
      if (!isIn_) {
        reply(std::string("\x1F\x04\x00", 3), now);
      } else if (!packet.starts_with("\x02\x0D") || sum % 256 != 0) {
        reply("\x15", now);
      } else {
        obey(packet.substr(2, kFrame), now);
      }
    }
  }

  static std::string digestOf(const std::string& text) {
    std::array<Byte, 16> bytes{};
    gnutls_hash_fast(GNUTLS_DIG_MD5, text.data(), text.size(), bytes.data());
    std::string digits;
    for (const Byte byte : bytes) {
      digits += "0123456789abcdef"[byte >> 4U];
      digits += "0123456789abcdef"[byte & 15U];
    }
    return digits;
  }

  void reply(std::string bytes, Time now) {
    if (options_.network) bytes += number_;
    say(bytes, now);
  }
  void refuse(Time now) { reply(std::string("\x1C\x00\x00", 3), now); }
  void confirm(Time now) { reply("\x06", now); }
  void answer(int value, Time now) {
    reply(std::string{'\x1D', static_cast<char>(value & 255), static_cast<char>(value >> 8U)}, now);
  }

  void power(int operation, int value, Time now) {
    if (operation == kGet) {
      const bool cools = state().power == ProjectorState::Power::kCooling;
      return answer(cools ? 2 : state().power == ProjectorState::Power::kOff ? 0 : 1, now);
    }
    state().setPower(value == 1, now);
    confirm(now);
  }

  int* numberOf(int type) {
    ProjectorState& its = state();
    switch (type) {
      case 0x2000:
        return &its.input;
      case 0x2003:
        return &its.brightness;
      case 0x2004:
        return &its.contrast;
      case 0x2407:
        return &memory_;
      case 0x30B1:
      case 0x30B2:
      case 0x30B3:
        return &its.gain.at(static_cast<std::size_t>(type - 0x30B1));
      case 0x1090:
        return &its.hours;
      default:
        return nullptr;
    }
  }

  ProjectorState::Motor* motorOf(int type) {
    ProjectorState::Lens& lens = state().lens;
    const std::array<ProjectorState::Motor*, 4> motors = {&lens.focus, &lens.zoom, &lens.shiftV, &lens.shiftH};
    return type >= 0x2400 && type <= 0x2403 ? motors.at(static_cast<std::size_t>(type - 0x2400)) : nullptr;
  }

  void get(int type, Time now) {
    if (type == 0x2405) return answer(state().mute ? 1 : 0, now);
    if (type == 0x6020 || type == 0x109E) return answer(0, now);
    if (type == 0x10A0) return answer(88, now);
    const int* number = numberOf(type);
    if (number == nullptr) return refuse(now);
    answer(*number, now);
  }

  void change(int operation, int type, int value, Time now) {
    const int step = operation == kIncrement ? 1 : operation == kDecrement ? -1 : 0;
    const bool done = step != 0               ? take(type, step)
                      : operation == kSet     ? set(type, value)
                      : operation == kExecute ? execute(type)
                                              : false;
    if (!done) return refuse(now);
    confirm(now);
  }

  bool take(int type, int step) {
    if (auto* motor = motorOf(type)) {
      if (!suffers(Fault::kStuck)) motor->turn(step);
      return true;
    }
    int* number = numberOf(type);
    // At its end it stays there and says so.
    if (number == nullptr || type == 0x2000 || type == 0x2407 || *number + step < 0 || *number + step > kMost)
      return false;
    if (!suffers(Fault::kStuck)) *number += step;
    return true;
  }

  bool set(int type, int value) {
    if (type == 0x2405) {
      state().mute = value == 1;
      return true;
    }
    if (type != 0x2000 && (type != 0x2407 || value > 2)) return false;
    *numberOf(type) = value;
    return true;
  }

  bool execute(int type) {
    auto& memory = state().lensMemory.at(static_cast<std::size_t>(memory_));
    if (type == 0x2408) state().lens = memory;
    if (type == 0x2409) memory = state().lens;
    return type == 0x2408 || type == 0x2409;
  }

  HitachiBeefSimulatorOptions options_;
  std::string typed_;
  char number_ = 0;  // of the packet that is answered
  bool isIn_ = true;
  int memory_ = 0;
};

}  // namespace

std::unique_ptr<ProjectorSimulator> makeHitachiBeefSimulator(const HitachiBeefSimulatorOptions& options) {
  return std::make_unique<HitachiBeefSimulator>(options);
}

}  // namespace pixelflex::devices
