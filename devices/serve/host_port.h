#pragma once

#include <memory>
#include <string>

#include "devices/simulate/simulated_device.h"
#include "devices/transport/line_address.h"
#include "devices/transport/line_loop.h"
#include "devices/transport/line_timer.h"

namespace pixelflex::devices {

/// One device at one line. All on the loop's thread.
class HostPort {
 public:
  HostPort(boost::asio::io_context& context, std::unique_ptr<SimulatedDevice> device);
  virtual ~HostPort() = default;
  HostPort(const HostPort&) = delete;
  HostPort& operator=(const HostPort&) = delete;

  [[nodiscard]] SimulatedDevice& device() { return *device_; }
  [[nodiscard]] virtual std::string address() const = 0;
  /// Throws std::runtime_error. May be called again after closeLine().
  virtual void openLine() = 0;
  virtual void closeLine() = 0;
  /// After the device was touched from outside.
  void attend();

 protected:
  void take(std::string_view bytes);
  virtual void give(const std::string& bytes) = 0;
  virtual void endClient() {}

 private:
  std::unique_ptr<SimulatedDevice> device_;
  LineTimer timer_;
};

/// A terminal, and a link to it at `path`.
[[nodiscard]] std::unique_ptr<HostPort> makeTerminalPort(boost::asio::io_context& context,
                                                         std::unique_ptr<SimulatedDevice> device, std::string path);
/// Port 0 means a free one. The newest client is the one that is heard.
[[nodiscard]] std::unique_ptr<HostPort> makeTcpPort(boost::asio::io_context& context,
                                                    std::unique_ptr<SimulatedDevice> device, std::string host,
                                                    int port);

}  // namespace pixelflex::devices
