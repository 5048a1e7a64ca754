#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "devices/simulate/simulated_device.h"
#include "devices/transport/line_address.h"
#include "devices/transport/line_loop.h"

namespace pixelflex::devices {

class HostPort;

/// Opens real lines to simulated devices, all served by one thread: a terminal (with a link to it where a serial device
/// would be) or a TCP port of this machine. Thread-safe. The destructor closes and removes all.
class DeviceHost {
 public:
  DeviceHost();
  ~DeviceHost();
  DeviceHost(const DeviceHost&) = delete;
  DeviceHost& operator=(const DeviceHost&) = delete;

  /// `at` is serial:PATH, where nothing may be but the link of a host that was killed, or tcp://HOST:PORT with a host
  /// of this machine. Throws std::runtime_error, also for names that are taken.
  void add(const std::string& name, std::unique_ptr<SimulatedDevice> device, const LineAddress& at);
  /// At a free TCP port of 127.0.0.1.
  void add(const std::string& name, std::unique_ptr<SimulatedDevice> device);
  /// What a user would write to reach it.
  [[nodiscard]] std::string address(const std::string& name) const;

  /// Runs `action` with the device as it is now, on the host's thread.
  void with(const std::string& name, const std::function<void(SimulatedDevice&, SimulatedDevice::Time)>& action);
  /// Kind by kind; Fault::kCut closes the line and everything that is connected to it.
  void order(const std::string& name, Fault fault, int times = SimulatedDevice::kForEver);
  void heal(const std::string& name);

 private:
  [[nodiscard]] HostPort& port(const std::string& name) const;

  LineLoop loop_;
  std::map<std::string, std::unique_ptr<HostPort>> ports_;
};

}  // namespace pixelflex::devices
