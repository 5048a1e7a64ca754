#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <ostream>
#include <string>
#include <thread>
#include <tuple>

#include "devices/projector_control/device_factory.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/simulators.h"
#include "devices/transport/line_loop.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_devices/bridges.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using ::testing::HasSubstr;

/// How the driver reaches the simulated device's terminal.
enum class Way { kTerminal, kRaw, kRfc2217, kSocat };

struct Serial {
  std::string driver;
  std::string setting;
  double number;
};

void PrintTo(const Serial& serial, std::ostream* stream) {
  *stream << serial.driver;
}

/// Every serial driver, by every way: directly, through ser2net and through socat.
class DeviceLadderTest : public ::testing::TestWithParam<std::tuple<Serial, Way>> {
 protected:
  void SetUp() override {
    terminal_ = (folder_ / "line").string();
    host_.add("p1", devices::makeSimulator(serial().driver), {.kind = devices::LineKind::kSerial, .path = terminal_});
    const Way way = std::get<Way>(GetParam());
    if (way != Way::kTerminal) bridge_ = std::make_unique<Bridge>(kindOf(way), terminal_);
    at_ = bridge_ ? bridge_->address() : "serial:" + terminal_;
  }

  static Serial serial() { return std::get<Serial>(GetParam()); }
  static Bridge::Kind kindOf(Way way) {
    return way == Way::kRaw       ? Bridge::Kind::kSer2netRaw
           : way == Way::kRfc2217 ? Bridge::Kind::kSer2netRfc2217
                                  : Bridge::Kind::kSocat;
  }
  std::unique_ptr<devices::Device> open(const std::string& options = "") {
    return devices::makeDevice(loop_, {.name = "p1.control",
                                       .driver = serial().driver,
                                       .at = at_ + options,
                                       .infocusGap = std::chrono::milliseconds(5)});
  }

  /// A bridge may need a while to see that its device is there again.
  static bool recovers(devices::Device& device) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      try {
        return device.read(serial().setting) == devices::SettingValue(serial().number);
      } catch (const std::runtime_error&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    }
    return false;
  }

  TemporaryFolder folder_;
  devices::DeviceHost host_;
  std::string terminal_;
  std::unique_ptr<Bridge> bridge_;
  std::string at_;
  devices::LineLoop loop_;
};

TEST_P(DeviceLadderTest, SetsAndReads) {
  const auto device = open();
  device->write(serial().setting, serial().number);
  EXPECT_EQ(device->read(serial().setting), devices::SettingValue(serial().number));
  host_.order("p1", Fault::kSilent);
  EXPECT_THROW((void)device->read(serial().setting), std::runtime_error);
  host_.heal("p1");
  EXPECT_TRUE(recovers(*device));
  host_.order("p1", Fault::kCut);
  EXPECT_THROW((void)device->read(serial().setting), std::runtime_error);
  host_.heal("p1");
  EXPECT_TRUE(recovers(*device));
}

std::string nameOf(const ::testing::TestParamInfo<std::tuple<Serial, Way>>& info) {
  const std::array kWays = {"Terminal", "Ser2netRaw", "Ser2netRfc2217", "Socat"};
  std::string name =
      std::get<Serial>(info.param).driver + "_" + kWays.at(static_cast<std::size_t>(std::get<Way>(info.param)));
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Ways, DeviceLadderTest,
    ::testing::Combine(::testing::Values(Serial{"ptu", "pan_counts", 120}, Serial{"hitachi-legacy", "brightness", 70},
                                         Serial{"hitachi-beef", "brightness", 66}, Serial{"escvp21", "brightness", 200},
                                         Serial{"infocus", "brightness", 99}),
                       ::testing::Values(Way::kTerminal, Way::kRaw, Way::kRfc2217, Way::kSocat)),
    nameOf);

class SerialSpeedTest : public DeviceLadderTest {
 protected:
  [[nodiscard]] speed_t speed() const {
    const int terminal = ::open(terminal_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios mode{};
    ::tcgetattr(terminal, &mode);
    ::close(terminal);
    return ::cfgetispeed(&mode);
  }
};

// What the address asks for is set at the far end.
TEST_P(SerialSpeedTest, IsSetWhereTheLineIs) {
  const auto device = open("?baud=19200");
  (void)device->read(serial().setting);
  EXPECT_EQ(speed(), static_cast<speed_t>(B19200));
}

INSTANTIATE_TEST_SUITE_P(Ways, SerialSpeedTest,
                         ::testing::Combine(::testing::Values(Serial{"escvp21", "brightness", 200}),
                                            ::testing::Values(Way::kTerminal, Way::kRfc2217)),
                         nameOf);

TEST(SerialLine, IsRefusedToASecondUser) {
  const TemporaryFolder folder;
  devices::DeviceHost host;
  const std::string path = (folder / "line").string();
  host.add("p1", devices::makeSimulator("escvp21"), {.kind = devices::LineKind::kSerial, .path = path});
  devices::LineLoop loop;
  const auto first = devices::makeDevice(loop, {.name = "first", .driver = "escvp21", .at = "serial:" + path});
  (void)first->read("power");
  const auto second = devices::makeDevice(loop, {.name = "second", .driver = "escvp21", .at = "serial:" + path});
  try {
    (void)second->read("power");
    FAIL() << "it was let in";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("busy"));
  }
}

TEST(SerialLine, ThatIsCutIsLostAndFoundAgain) {
  const TemporaryFolder folder;
  devices::DeviceHost host;
  const std::string path = (folder / "line").string();
  host.add("p1", devices::makeSimulator("escvp21"), {.kind = devices::LineKind::kSerial, .path = path});
  devices::LineLoop loop;
  const auto device = devices::makeDevice(loop, {.name = "p1", .driver = "escvp21", .at = "serial:" + path});
  EXPECT_EQ(devices::textOf(device->read("power")), "on");
  host.order("p1", Fault::kCut);
  EXPECT_THROW((void)device->read("power"), std::runtime_error);
  host.heal("p1");
  EXPECT_EQ(devices::textOf(device->read("power")), "on");
}

}  // namespace
}  // namespace pixelflex::testing
