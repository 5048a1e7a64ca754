#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

constexpr std::size_t kLongest = 80;

struct Range {
  int minimum;
  int maximum;
};

class InfocusSimulator : public ProjectorSimulator {
 public:
  InfocusSimulator() { state().brightness = state().contrast = 128; }

  void receive(std::string_view bytes, Time now) override {
    advance(now);
    typed_ += bytes;
    for (auto end = typed_.find(')'); end != std::string::npos; end = typed_.find(')')) {
      const auto begin = typed_.rfind('(', end);
      if (begin != std::string::npos) obey(typed_.substr(begin + 1, end - begin - 1), now);
      typed_.erase(0, end + 1);
    }
    if (typed_.size() > kLongest) typed_.clear();
  }

 private:
  void obey(const std::string& command, Time now) {
    if (command.size() < 4) return say("?", now);
    const std::string name = command.substr(0, 3);
    const std::string value = command.substr(3);
    if (suffers(Fault::kBusy)) return;
    if (value == "?") return get(name, now);
    set(name, value, now);
  }

  int* numberOf(const std::string& name, Range& range) {
    ProjectorState& its = state();
    range = {0, 100};
    if (name == "BCG") return &its.gain[2];
    if (name == "GCG") return &its.gain[1];
    if (name == "RCG") return its.gain.data();
    range = {96, 160};
    if (name == "BRT") return &its.brightness;
    if (name == "CON") return &its.contrast;
    range = {0, 2};
    if (name == "SRC") return &its.input;
    range = {0, 32766};
    return name == "LMP" ? &its.hours : nullptr;
  }

  void get(const std::string& name, Time now) {
    const auto answer = [&](Range range, int value) {
      say("(" + std::to_string(range.minimum) + "-" + std::to_string(range.maximum) + "," + std::to_string(value) + ")",
          now);
    };
    if (name == "PWR") return answer({0, 1}, state().isOn() ? 1 : 0);
    if (name == "BLK") return answer({0, 1}, state().mute ? 1 : 0);
    if (name == "ZOM") return answer({0, 1}, 0);
    Range range{};
    const int* number = numberOf(name, range);
    if (number == nullptr) return say("?", now);
    answer(range, *number);
  }

  void set(const std::string& name, const std::string& text, Time now) {
    int value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return say("?", now);
    if (name == "PWR") {
      if (value > 1) return say("?", now);
      return state().setPower(value == 1, now);
    }
    if (name == "BLK") state().mute = value != 0;
    if (name == "ZOM" && !suffers(Fault::kStuck)) state().lens.zoom.turn(value != 0 ? 1 : -1);
    Range range{};
    // More than there is counts as the most.
    int* number = numberOf(name, range);
    if (number != nullptr && name != "LMP") *number = std::clamp(value, range.minimum, range.maximum);
  }

  std::string typed_;
};

}  // namespace

std::unique_ptr<ProjectorSimulator> makeInfocusSimulator() {
  return std::make_unique<InfocusSimulator>();
}

}  // namespace pixelflex::devices
