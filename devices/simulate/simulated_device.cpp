#include "devices/simulate/simulated_device.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pixelflex::devices {
namespace {

constexpr std::array kFaultNames = {std::pair{"drop", Fault::kDrop},   std::pair{"garble", Fault::kGarble},
                                    std::pair{"slow", Fault::kSlow},   std::pair{"silent", Fault::kSilent},
                                    std::pair{"stuck", Fault::kStuck}, std::pair{"busy", Fault::kBusy},
                                    std::pair{"cut", Fault::kCut}};
constexpr std::size_t kMostOutput = 65536;

}  // namespace

std::optional<Fault> faultOfName(std::string_view name) {
  for (const auto& [known, fault] : kFaultNames) {
    if (name == known) return fault;
  }
  return std::nullopt;
}

std::string SimulatedDevice::take(Time now) {
  std::string bytes;
  while (!due_.empty() && due_.front().at <= now) {
    bytes += due_.front().bytes;
    due_.pop_front();
  }
  return bytes;
}

std::optional<SimulatedDevice::Time> SimulatedDevice::nextDue() const {
  if (due_.empty()) return std::nullopt;
  return due_.front().at;
}

void SimulatedDevice::order(Fault fault, int times) {
  fault_ = fault;
  times_ = times;
}

void SimulatedDevice::say(std::string bytes, Time at) {
  const auto fault = fault_;
  if (fault && --times_ <= 0) heal();
  if (fault == Fault::kSilent || due_.size() > kMostOutput) return;
  if (fault == Fault::kSlow) at += kSlowness;
  if (fault == Fault::kDrop && !bytes.empty()) bytes.erase(0, 1);
  if (fault == Fault::kGarble && !bytes.empty()) bytes[0] = static_cast<char>(bytes[0] ^ 0x40);
  if (!due_.empty()) at = std::max(at, due_.back().at);
  due_.push_back({at, std::move(bytes)});
}

}  // namespace pixelflex::devices
