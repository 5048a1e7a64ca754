#include "devices/serve/device_host.h"

#include <cassert>
#include <stdexcept>
#include <utility>

#include "devices/serve/host_port.h"

namespace pixelflex::devices {
namespace {

using Clock = SimulatedDevice::Time::clock;

std::unique_ptr<HostPort> makePort(boost::asio::io_context& context, std::unique_ptr<SimulatedDevice> device,
                                   const LineAddress& at) {
  if (at.kind == LineKind::kSerial) return makeTerminalPort(context, std::move(device), at.path);
  if (at.kind == LineKind::kTcp) return makeTcpPort(context, std::move(device), at.host, at.port);
  throw std::runtime_error(at.text() + ": a simulated device is served at serial:PATH or tcp://127.0.0.1:PORT");
}

}  // namespace

HostPort::HostPort(boost::asio::io_context& context, std::unique_ptr<SimulatedDevice> device)
    : device_(std::move(device)), timer_(context) {}

void HostPort::take(std::string_view bytes) {
  device_->receive(bytes, Clock::now());
  attend();
}

void HostPort::attend() {
  const std::string bytes = device_->take(Clock::now());
  if (!bytes.empty()) give(bytes);
  if (device_->wantsClose()) endClient();
  const auto due = device_->nextDue();
  if (due) {
    timer_.setAt(*due, [this] {
      device_->advance(Clock::now());
      attend();
    });
  }
}

DeviceHost::DeviceHost() = default;

DeviceHost::~DeviceHost() {
  loop_.invoke([this] { ports_.clear(); });
}

void DeviceHost::add(const std::string& name, std::unique_ptr<SimulatedDevice> device, const LineAddress& at) {
  loop_.invoke([&] {
    if (ports_.contains(name)) throw std::runtime_error(name + ": there is such a device already");
    auto port = makePort(loop_.context(), std::move(device), at);
    if (!port->device().suffers(Fault::kCut)) port->openLine();
    ports_[name] = std::move(port);
  });
}

void DeviceHost::add(const std::string& name, std::unique_ptr<SimulatedDevice> device) {
  add(name, std::move(device), {.kind = LineKind::kTcp, .host = "127.0.0.1"});
}

HostPort& DeviceHost::port(const std::string& name) const {
  const auto found = ports_.find(name);
  if (found == ports_.end()) throw std::runtime_error(name + ": there is no such device");
  return *found->second;
}

std::string DeviceHost::address(const std::string& name) const {
  return port(name).address();
}

void DeviceHost::with(const std::string& name,
                      const std::function<void(SimulatedDevice&, SimulatedDevice::Time)>& action) {
  loop_.invoke([&] {
    HostPort& its = port(name);
    const auto now = Clock::now();
    its.device().advance(now);
    action(its.device(), now);
    its.attend();
  });
}

void DeviceHost::order(const std::string& name, Fault fault, int times) {
  loop_.invoke([&] {
    HostPort& its = port(name);
    its.device().advance(Clock::now());
    its.device().order(fault, times);
    if (fault == Fault::kCut) its.closeLine();
  });
}

void DeviceHost::heal(const std::string& name) {
  loop_.invoke([&] {
    HostPort& its = port(name);
    its.device().advance(Clock::now());
    const bool wasCut = its.device().suffers(Fault::kCut);
    its.device().heal();
    if (wasCut) its.openLine();
  });
}

}  // namespace pixelflex::devices
