#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "devices/pan_tilt/pan_tilt_device.h"
#include "devices/pan_tilt/pan_tilt_unit.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/pan_tilt_simulator.h"

namespace pixelflex::testing {
namespace {

using devices::DeviceError;
using devices::DeviceHost;
using devices::Fault;
using devices::LineError;
using devices::LineLoop;
using devices::PanTiltAxis;
using devices::PanTiltSimulator;
using devices::PanTiltUnit;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr auto kPan = PanTiltAxis::kPan;
constexpr auto kTilt = PanTiltAxis::kTilt;

template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

class PanTiltUnitTest : public ::testing::Test {
 protected:
  void SetUp() override { serve({.speedFactor = 5}); }

  void serve(const PanTiltSimulator::Options& options) {
    unit_.reset();
    host_ = std::make_unique<DeviceHost>();
    host_->add("ptu", std::make_unique<PanTiltSimulator>(options));
    unit_ = std::make_unique<PanTiltUnit>(loop_, devices::parseLineAddress(host_->address("ptu")), "p1.mirror");
  }

  template <class Get>
  auto simulated(Get get) {
    decltype(get(std::declval<PanTiltSimulator&>())) result{};
    host_->with("ptu",
                [&](devices::SimulatedDevice& device, auto) { result = get(dynamic_cast<PanTiltSimulator&>(device)); });
    return result;
  }
  bool moves() {
    return simulated([](PanTiltSimulator& unit) { return unit.isMoving(); });
  }
  std::string type(const std::string& command) {
    std::string reply;
    host_->with("ptu", [&](devices::SimulatedDevice& device, devices::SimulatedDevice::Time now) {
      device.receive(command, now);
      reply = device.take(now);
    });
    return reply;
  }
  void waitUntilItMoves() {
    while (!moves()) std::this_thread::sleep_for(milliseconds(2));
  }

  LineLoop loop_;
  std::unique_ptr<DeviceHost> host_;
  std::unique_ptr<PanTiltUnit> unit_;
};

TEST_F(PanTiltUnitTest, ReadsWhatTheUnitIs) {
  EXPECT_THAT(unit_->version(), HasSubstr("v1.09.0b"));
  const auto& pan = unit_->motor(kPan);
  EXPECT_EQ(pan.minimum, -3090);
  EXPECT_EQ(pan.maximum, 3090);
  EXPECT_NEAR(pan.degreesPerCount, 0.0514286, 1e-6);
  EXPECT_EQ(pan.speed, 1000);
  EXPECT_EQ(pan.acceleration, 2000);
  EXPECT_EQ(pan.base, 1000);
  EXPECT_EQ(pan.upper, 2902);
  EXPECT_EQ(pan.lower, 31);
  EXPECT_EQ(unit_->motor(kTilt).minimum, -907);
  EXPECT_EQ(unit_->motor(kTilt).maximum, 604);
  EXPECT_EQ(pan.counts(21.3), 414);  // the manual's example
}

TEST_F(PanTiltUnitTest, MovesBothAxesAndReturnsWhenTheyAreThere) {
  unit_->moveTo(500, -200);
  EXPECT_FALSE(moves());
  EXPECT_EQ(unit_->position(kPan), 500);
  EXPECT_EQ(unit_->position(kTilt), -200);
  unit_->moveTo(std::nullopt, 100);
  EXPECT_EQ(unit_->position(kPan), 500);
  EXPECT_EQ(unit_->position(kTilt), 100);
}

TEST_F(PanTiltUnitTest, MeetsAHalfTypedCommandAndEveryModeAndPutsThemBack) {
  (void)type("FV EE PP12");
  EXPECT_EQ(unit_->position(kPan), 0);  // half a command is not carried out
  unit_.reset();
  EXPECT_EQ(type("E "), "E * Echoing ON\r\n");
  EXPECT_THAT(type("PP "), HasSubstr("Current Pan position is"));
}

TEST_F(PanTiltUnitTest, AQuietUnitIsLeftQuiet) {
  (void)type("ED FT ");
  (void)unit_->position(kPan);
  unit_.reset();
  EXPECT_EQ(type("PP "), "* 0\r\n");
}

TEST_F(PanTiltUnitTest, SpeaksToUnitsThatEndLinesWithoutLineFeeds) {
  serve({.lineFeeds = false, .speedFactor = 5});
  unit_->moveTo(30, 40);
  EXPECT_EQ(unit_->position(kTilt), 40);
}

TEST_F(PanTiltUnitTest, RefusesToGoPastTheLimitsEvenWhenTheUnitWouldNot) {
  unit_->setLimitsEnabled(false);
  EXPECT_FALSE(unit_->limitsEnabled());
  const std::string message = complaint([&] { unit_->moveTo(3091, 0); });
  EXPECT_THAT(message, HasSubstr("p1.mirror at tcp://127.0.0.1:"));
  EXPECT_THAT(message, HasSubstr("pan cannot go to 3091 counts"));
  EXPECT_THAT(message, HasSubstr("only from -3090 counts (-158.9142 deg) to 3090 counts (158.9142 deg)"));
  EXPECT_THAT(complaint([&] { unit_->moveTo(0, -908); }), HasSubstr("tilt cannot go to -908"));
  EXPECT_FALSE(moves());
  unit_->setLimitsEnabled(true);
  EXPECT_TRUE(unit_->limitsEnabled());
}

TEST_F(PanTiltUnitTest, SetsSpeedAndAcceleration) {
  unit_->setSpeed(kPan, 700);
  unit_->setAcceleration(kTilt, 3000);
  EXPECT_EQ(simulated([](PanTiltSimulator& unit) { return unit.motor(PanTiltSimulator::kPan).speed; }), 700);
  EXPECT_EQ(simulated([](PanTiltSimulator& unit) { return unit.motor(PanTiltSimulator::kTilt).acceleration; }), 3000);
  EXPECT_THAT(complaint([&] { unit_->setSpeed(kPan, 5); }), HasSubstr("Motor speed cannot be less than 31"));
}

TEST_F(PanTiltUnitTest, WaitsForUnitsThatMakeTheirTablesSlowly) {
  serve({.speedFactor = 5, .tableTime = milliseconds(1200)});
  unit_->setAcceleration(kPan, 1500);
  EXPECT_EQ(unit_->motor(kPan).acceleration, 1500);
}

TEST_F(PanTiltUnitTest, HaltGoesBeforeAMoveThatAnotherThreadWaitsFor) {
  serve({.speedFactor = 0.05});
  auto move = std::async(std::launch::async, [&] { return complaint([&] { unit_->moveTo(3000, 600); }); });
  waitUntilItMoves();
  unit_->halt();
  EXPECT_FALSE(moves());
  EXPECT_THAT(move.get(), HasSubstr("halted"));
}

TEST_F(PanTiltUnitTest, AStopRequestHalts) {
  serve({.speedFactor = 0.05});
  std::stop_source stop;
  auto move = std::async(std::launch::async,
                         [&] { return complaint([&] { unit_->moveTo(3000, 600, {.stop = stop.get_token()}); }); });
  waitUntilItMoves();
  stop.request_stop();
  EXPECT_THAT(move.get(), HasSubstr("stopped on request"));
  EXPECT_FALSE(moves());
}

TEST_F(PanTiltUnitTest, AStuckAxisIsNamedAndAllStands) {
  (void)unit_->version();
  host_->order("ptu", Fault::kStuck);
  const auto begun = Clock::now();
  EXPECT_THAT(complaint([&] { unit_->moveTo(100, 50); }),
              HasSubstr("pan stays at 0 counts instead of going to 100: is it blocked?"));
  EXPECT_LT(Clock::now() - begun, seconds(20));
  host_->heal("ptu");
  EXPECT_FALSE(moves());
  unit_->moveTo(100, 50);
  EXPECT_EQ(unit_->position(kPan), 100);
}

TEST_F(PanTiltUnitTest, AnAxisThatMeetsItsStopIsNotTrustedAnyMore) {
  serve({.speedFactor = 0.05});
  auto move = std::async(std::launch::async, [&] { return complaint([&] { unit_->moveTo(std::nullopt, 600); }); });
  waitUntilItMoves();
  host_->with("ptu", [](devices::SimulatedDevice& device, devices::SimulatedDevice::Time now) {
    dynamic_cast<PanTiltSimulator&>(device).reportStop(PanTiltSimulator::kTilt, now);
  });
  EXPECT_THAT(move.get(), HasSubstr("tilt ran into its stop"));
  EXPECT_FALSE(moves());
}

TEST_F(PanTiltUnitTest, ResetsAndReadsTheLimitsAgain) {
  serve({.speedFactor = 50});
  unit_->moveTo(300, 20);
  unit_->reset();
  EXPECT_EQ(unit_->position(kPan), 0);
  EXPECT_EQ(unit_->motor(kPan).maximum, 3090);
}

TEST_F(PanTiltUnitTest, ALostOrDamagedReplyIsAskedForAgain) {
  (void)unit_->version();
  for (const Fault fault : {Fault::kDrop, Fault::kGarble, Fault::kSilent}) {
    host_->order("ptu", fault, 1);
    EXPECT_EQ(unit_->position(kPan), 0);
  }
}

TEST_F(PanTiltUnitTest, ASilentUnitIsNamedInBoundedTime) {
  host_->order("ptu", Fault::kSilent);
  const auto begun = Clock::now();
  EXPECT_THAT(complaint([&] { (void)unit_->position(kPan); }), HasSubstr("no reply; is it switched on"));
  EXPECT_LT(Clock::now() - begun, seconds(20));
  host_->heal("ptu");
  EXPECT_EQ(unit_->position(kPan), 0);
}

TEST_F(PanTiltUnitTest, AfterACutLineAndANewPowerItIsMadeReadyAgain) {
  (void)unit_->position(kPan);
  host_->order("ptu", Fault::kCut);
  EXPECT_THAT(complaint([&] { (void)unit_->position(kPan); }), HasSubstr("connection"));
  EXPECT_THAT(complaint([&] { (void)unit_->position(kPan); }), HasSubstr("no connection: Connection refused"));
  host_->heal("ptu");
  host_->with("ptu", [](devices::SimulatedDevice& device, devices::SimulatedDevice::Time now) {
    dynamic_cast<PanTiltSimulator&>(device).powerCycle(now);
  });
  unit_->moveTo(10, 10);
  EXPECT_EQ(unit_->position(kTilt), 10);
}

TEST_F(PanTiltUnitTest, WhatGoesAwayWhileItMovesIsHalted) {
  serve({.speedFactor = 0.05});
  auto device = devices::makePanTiltDevice(loop_, devices::parseLineAddress(host_->address("ptu")), "p1.mirror");
  auto move = std::async(std::launch::async, [&] { return complaint([&] { device->write("pan", 90.0); }); });
  waitUntilItMoves();
  host_->order("ptu", Fault::kSilent, 8);  // so that the move gives up without a word of the unit
  EXPECT_NE(move.get(), "");
  device.reset();
  EXPECT_FALSE(moves());
}

TEST_F(PanTiltUnitTest, AsADeviceItHasAnglesAndCounts) {
  const auto device = devices::makePanTiltDevice(loop_, devices::parseLineAddress(host_->address("ptu")), "p1.mirror");
  device->writeAll({{"pan", 21.3}, {"tilt_counts", -100.0}});
  EXPECT_EQ(device->read("pan_counts"), devices::SettingValue(414.0));
  EXPECT_NEAR(std::get<double>(device->read("tilt")), -5.14286, 1e-4);
  device->nudge("pan", 1);
  EXPECT_EQ(device->read("pan_counts"), devices::SettingValue(433.0));
  device->nudge("tilt_counts", 1e6);  // to the end and no further
  EXPECT_EQ(device->read("tilt_counts"), devices::SettingValue(604.0));
  device->write("pan_speed", 500.0);
  EXPECT_EQ(device->read("pan_speed"), devices::SettingValue(500.0));
  EXPECT_EQ(device->read("limits"), devices::SettingValue("on"));
  device->act("home");
  EXPECT_EQ(device->read("pan"), devices::SettingValue(0.0));
  EXPECT_THAT(complaint([&] { device->write("pan", 200.0); }), HasSubstr("from -158.9142 to 158.9142 deg"));
  EXPECT_THAT(complaint([&] { device->write("zoom", 2.0); }), HasSubstr("has no setting \"zoom\", only pan, "));
  EXPECT_THAT(complaint([&] { device->act("dance"); }), HasSubstr("cannot do \"dance\""));
}

}  // namespace
}  // namespace pixelflex::testing
