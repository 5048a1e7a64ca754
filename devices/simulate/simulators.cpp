#include "devices/simulate/simulators.h"

#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <stdexcept>

#include "devices/simulate/pan_tilt_simulator.h"
#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

using Options = std::map<std::string, std::string, std::less<>>;

struct Kind {
  std::string_view name;
  std::unique_ptr<SimulatedDevice> (*make)(Options& options);
};

/// Takes an option away, so that what remains is unknown.
int takeNumber(Options& options, const std::string& name, int otherwise) {
  const auto node = options.extract(name);
  if (node.empty()) return otherwise;
  const std::string& text = node.mapped();
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument("sim: " + name + " is a whole number, not \"" + text + "\"");
  }
  return value;
}

std::unique_ptr<SimulatedDevice> makePanTilt(Options& options) {
  return std::make_unique<PanTiltSimulator>(PanTiltSimulator::Options{.firstPan = takeNumber(options, "pan", 0),
                                                                      .firstTilt = takeNumber(options, "tilt", 0)});
}

/// What all projectors can be asked to be.
void setUp(ProjectorSimulator& projector, Options& options) {
  ProjectorState& state = projector.state();
  state.hours = takeNumber(options, "hours", state.hours);
  state.warmUp = std::chrono::milliseconds(takeNumber(options, "warm-up-ms", static_cast<int>(state.warmUp.count())));
  state.coolDown =
      std::chrono::milliseconds(takeNumber(options, "cool-down-ms", static_cast<int>(state.coolDown.count())));
}

template <std::unique_ptr<ProjectorSimulator> (*kMake)()>
std::unique_ptr<SimulatedDevice> makeProjector(Options& options) {
  auto projector = kMake();
  setUp(*projector, options);
  return projector;
}

std::unique_ptr<SimulatedDevice> makeBeef(Options& options) {
  HitachiBeefSimulatorOptions how{.network = takeNumber(options, "network", 0) != 0};
  if (const auto node = options.extract("password"); !node.empty()) how.password = node.mapped();
  auto projector = makeHitachiBeefSimulator(how);
  setUp(*projector, options);
  return projector;
}

std::unique_ptr<SimulatedDevice> makePjlink(Options& options) {
  PjlinkSimulatorOptions how{.pjlinkClass = takeNumber(options, "class", 2),
                             .sha256 = takeNumber(options, "sha256", 1) != 0};
  if (const auto node = options.extract("password"); !node.empty()) how.password = node.mapped();
  auto projector = makePjlinkSimulator(how);
  setUp(*projector, options);
  return projector;
}

constexpr std::array kKinds = {Kind{"ptu", makePanTilt},
                               Kind{"hitachi-legacy", makeProjector<makeHitachiLegacySimulator>},
                               Kind{"proxima-dp6850", makeProjector<makeHitachiLegacySimulator>},
                               Kind{"hitachi-beef", makeBeef},
                               Kind{"pjlink", makePjlink},
                               Kind{"escvp21", makeProjector<makeEscVp21Simulator>},
                               Kind{"infocus", makeProjector<makeInfocusSimulator>}};

Options optionsOf(std::string_view text) {
  Options options;
  while (!text.empty()) {
    const auto cut = text.find('&');
    const std::string_view option = text.substr(0, cut);
    text = cut == std::string_view::npos ? std::string_view() : text.substr(cut + 1);
    const auto equals = option.find('=');
    if (equals == std::string_view::npos) {
      throw std::invalid_argument("sim: \"" + std::string(option) + "\" is not written option=value");
    }
    options[std::string(option.substr(0, equals))] = option.substr(equals + 1);
  }
  return options;
}

std::string listOfKinds() {
  std::string list;
  for (const auto& kind : simulatorKinds()) list += (list.empty() ? "" : ", ") + kind;
  return list;
}

void orderFault(SimulatedDevice& device, Options& options) {
  const auto node = options.extract("fault");
  if (node.empty()) return;
  const auto fault = faultOfName(node.mapped());
  if (!fault) {
    throw std::invalid_argument("sim: there is no fault \"" + node.mapped() +
                                "\", only drop, garble, slow, silent, stuck, busy and cut");
  }
  device.order(*fault);
}

}  // namespace

std::vector<std::string> simulatorKinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::unique_ptr<SimulatedDevice> makeSimulator(std::string_view text) {
  const auto cut = text.find('?');
  const std::string_view name = text.substr(0, cut);
  Options options = cut == std::string_view::npos ? Options() : optionsOf(text.substr(cut + 1));
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    auto device = kind.make(options);
    orderFault(*device, options);
    if (!options.empty()) {
      throw std::invalid_argument("sim: " + std::string(name) + " has no option \"" + options.begin()->first + "\"");
    }
    return device;
  }
  throw std::invalid_argument("sim: there is no simulator of \"" + std::string(name) + "\", only of " + listOfKinds());
}

}  // namespace pixelflex::devices
