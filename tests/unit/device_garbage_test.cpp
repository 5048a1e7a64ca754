#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>

#include "devices/projector_control/device_factory.h"
#include "devices/simulate/simulators.h"
#include "devices/transport/line_loop.h"
#include "tests/support_devices/scripted_server.h"

namespace pixelflex::testing {
namespace {

/// What begins and ends messages of some protocol is more likely than by chance.
std::string garbage(std::mt19937& random, std::size_t longest) {
  static const std::string kTelling = "\x06\x15\x1C\x1D\x1F\x10\x13pp\xBE\xEF*!PT()?:=\r\n %1POWR=PJLINK 2";
  std::string bytes;
  for (std::size_t left = 1 + random() % longest; left > 0; --left) {
    bytes += random() % 2 == 0 ? kTelling[random() % kTelling.size()] : static_cast<char>(random() % 256);
  }
  return bytes + "\r):\n"[random() % 4];
}

class DeviceGarbageTest : public ::testing::TestWithParam<std::string> {};

// Neither crashes nor hangs; says that something is wrong, or takes it for an answer.
TEST_P(DeviceGarbageTest, DriversSurviveIt) {
  std::mt19937 random(7);
  ScriptedServer server([&](const std::string&) { return garbage(random, 40); });
  devices::LineLoop loop;
  const auto device = devices::makeDevice(loop, {.name = "p1",
                                                 .driver = GetParam(),
                                                 .at = server.address(),
                                                 .password = "secret",
                                                 .infocusGap = std::chrono::milliseconds(1)});
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 2; ++i) {
    try {
      (void)device->read(GetParam() == "ptu" ? "pan" : "power");
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(90));
}

TEST_P(DeviceGarbageTest, SimulatorsSurviveIt) {
  const auto device = devices::makeSimulator(GetParam());
  std::mt19937 random(11);
  devices::SimulatedDevice::Time now{std::chrono::seconds(1)};
  device->connected(now);
  std::size_t said = 0;
  for (int i = 0; i < 20000; ++i) {
    now += std::chrono::milliseconds(random() % 50);
    device->receive(garbage(random, 24), now);
    device->advance(now);
    said += device->take(now).size();
    if (device->wantsClose()) device->connected(now);
  }
  EXPECT_LT(said, std::size_t{20000} * 24 * 200);
}

std::string nameOf(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Drivers, DeviceGarbageTest, ::testing::ValuesIn(devices::deviceDrivers()), nameOf);

}  // namespace
}  // namespace pixelflex::testing
