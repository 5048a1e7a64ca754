#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support_devices/projector_bench.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

// Everything is over long before; a loaded machine is slow.
constexpr std::chrono::seconds kBound{40};

const std::vector<std::pair<std::string, std::string>> kReadable = {
    {"ptu", "pan"},      {"hitachi-legacy", "brightness"}, {"hitachi-beef", "brightness"},
    {"pjlink", "power"}, {"escvp21", "brightness"},        {"infocus", "brightness"}};
using Device = std::pair<std::string, std::string>;

/// Each driver with each fault: bounded time, a message that names the device, and all is well once it is healed.
class DriverFaultTest : public ::testing::TestWithParam<std::tuple<Device, Fault>> {};

TEST_P(DriverFaultTest, IsNamedInBoundedTimeAndHeals) {
  const auto& [device, fault] = GetParam();
  const auto& [kind, setting] = device;
  ProjectorBench bench(kind);
  const std::string before = bench.value(setting);
  bench.host().order("p1", fault);
  const auto begun = Clock::now();
  const std::string message = complaintOf([&] { EXPECT_EQ(bench.value(setting), before); });
  EXPECT_LT(Clock::now() - begun, kBound);
  if (!message.empty()) {
    EXPECT_THAT(message, HasSubstr("p1.control at tcp://127.0.0.1:"));
  }
  // What is merely late may be in time.
  if (fault == Fault::kCut || fault == Fault::kSilent || fault == Fault::kDrop || fault == Fault::kGarble) {
    EXPECT_NE(message, "");
  }
  bench.host().heal("p1");
  EXPECT_EQ(bench.value(setting), before);
}

std::string nameOf(const ::testing::TestParamInfo<std::tuple<Device, Fault>>& info) {
  static const std::vector<std::string> kNames = {"Drop", "Garble", "Slow", "Silent", "Stuck", "Busy", "Cut"};
  std::string name = std::get<0>(info.param).first + "_" + kNames.at(static_cast<std::size_t>(std::get<1>(info.param)));
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table, DriverFaultTest,
                         ::testing::Combine(::testing::ValuesIn(kReadable),
                                            ::testing::Values(Fault::kDrop, Fault::kGarble, Fault::kSlow,
                                                              Fault::kSilent, Fault::kBusy, Fault::kCut)),
                         nameOf);

class OneLostReplyTest : public ::testing::TestWithParam<Device> {};

TEST_P(OneLostReplyTest, IsAskedForAgain) {
  const auto& [kind, setting] = GetParam();
  ProjectorBench bench(kind);
  const std::string before = bench.value(setting);
  for (const Fault fault : {Fault::kDrop, Fault::kSilent}) {
    bench.host().order("p1", fault, 1);
    EXPECT_EQ(bench.value(setting), before);
  }
}

INSTANTIATE_TEST_SUITE_P(Table, OneLostReplyTest, ::testing::ValuesIn(kReadable));

}  // namespace
}  // namespace pixelflex::testing
