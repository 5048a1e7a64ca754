#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "devices/projector_control/device_factory.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/projector_simulator.h"
#include "devices/simulate/simulators.h"
#include "devices/transport/line_loop.h"

namespace pixelflex::testing {

/// A simulated projector behind a real TCP port and the driver that talks to it.
class ProjectorBench {
 public:
  /// `simulator` as after "sim:"; its kind is the driver's name.
  explicit ProjectorBench(const std::string& simulator, const std::string& password = "") {
    host_.add("p1", devices::makeSimulator(simulator));
    device_ = devices::makeDevice(loop_, {.name = "p1.control",
                                          .driver = simulator.substr(0, simulator.find('?')),
                                          .at = host_.address("p1"),
                                          .password = password,
                                          .infocusGap = std::chrono::milliseconds(5)});
  }

  [[nodiscard]] devices::Device& device() { return *device_; }
  [[nodiscard]] devices::DeviceHost& host() { return host_; }
  [[nodiscard]] std::string value(const std::string& setting) { return devices::textOf(device_->read(setting)); }
  void set(const std::string& setting, const std::string& text) { device_->write(setting, text); }
  void set(const std::string& setting, double number) { device_->write(setting, number); }
  [[nodiscard]] std::string names() {
    std::string list;
    for (const auto& info : device_->settings()) list += (list.empty() ? "" : " ") + info.name;
    return list;
  }
  [[nodiscard]] devices::ProjectorState state() {
    devices::ProjectorState state;
    host_.with("p1", [&](devices::SimulatedDevice& device, auto) {
      state = dynamic_cast<devices::ProjectorSimulator&>(device).state();
    });
    return state;
  }

 private:
  devices::DeviceHost host_;
  devices::LineLoop loop_;
  std::unique_ptr<devices::Device> device_;
};

/// What `action` complains about; empty when it does not.
template <class Action>
[[nodiscard]] std::string complaintOf(Action action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace pixelflex::testing
