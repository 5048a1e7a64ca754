#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/support_devices/projector_bench.h"

namespace pixelflex::testing {
namespace {

using devices::Progress;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST(HitachiLegacy, ControlsWhatThePanelOfTheReportDoes) {
  ProjectorBench bench("proxima-dp6850");
  EXPECT_EQ(bench.names(), "power input mute brightness contrast red blue zoom focus");
  bench.set("brightness", 100);
  bench.set("contrast", 20);
  bench.set("red", 90);
  bench.set("blue", 80);
  bench.set("mute", "on");
  bench.set("input", "rgb2");
  const auto state = bench.state();
  EXPECT_EQ(state.brightness, 100);
  EXPECT_EQ(state.contrast, 20);
  EXPECT_EQ(state.gain[0], 90);
  EXPECT_EQ(state.gain[2], 80);
  EXPECT_TRUE(state.mute);
  EXPECT_EQ(state.input, 0x22);
  EXPECT_EQ(bench.value("brightness"), "100");
  EXPECT_EQ(bench.value("mute"), "on");
  EXPECT_EQ(bench.value("input"), "rgb2");
  bench.device().nudge("brightness", -300);
  EXPECT_EQ(bench.value("brightness"), "0");
}

TEST(HitachiLegacy, FindsTheLensByItsEndAndCountsFromThere) {
  ProjectorBench bench("hitachi-legacy");
  bench.device().nudge("zoom", -7);
  EXPECT_EQ(bench.state().lens.zoom.place, 43);
  bench.set("zoom", 30);
  EXPECT_EQ(bench.state().lens.zoom.place, 30);
  bench.device().nudge("zoom", 5);
  bench.set("zoom", 80);  // from where it is known to be
  EXPECT_EQ(bench.state().lens.zoom.place, 80);
  bench.set("focus", 10);
  EXPECT_EQ(bench.state().lens.focus.place, 10);
  EXPECT_THAT(complaintOf([&] { (void)bench.value("zoom"); }), HasSubstr("zoom cannot be read"));
}

TEST(HitachiLegacy, WaitsForTheLampAndTellsMeanwhile) {
  ProjectorBench bench("hitachi-legacy?warm-up-ms=900&cool-down-ms=100");
  bench.set("power", "off");
  EXPECT_EQ(bench.value("power"), "off");
  std::vector<std::string> heard;
  bench.device().write("power", "on", {.report = [&](const std::string& text) { heard.push_back(text); }});
  EXPECT_TRUE(bench.state().isOn());
  EXPECT_THAT(heard, Contains("warming up, 0 s"));
}

TEST(HitachiLegacy, ALampNeedNotBeWaitedFor) {
  ProjectorBench bench("hitachi-legacy?cool-down-ms=60000");
  std::stop_source stop;
  Progress progress{.stop = stop.get_token(), .report = [&](const std::string&) { stop.request_stop(); }};
  EXPECT_THAT(complaintOf([&] { bench.device().write("power", "off", progress); }), HasSubstr("no longer waited for"));
}

TEST(HitachiBeef, StepsWhatCanOnlyBeStepped) {
  ProjectorBench bench("hitachi-beef");
  EXPECT_EQ(bench.names(),
            "power input mute brightness contrast red green blue zoom focus shift_h shift_v lens_memory hours "
            "filter_hours errors");
  bench.set("brightness", 70);
  bench.set("green", 95);
  EXPECT_EQ(bench.state().brightness, 70);
  EXPECT_EQ(bench.state().gain[1], 95);
  EXPECT_EQ(bench.value("green"), "95");
  bench.device().nudge("brightness", -4);
  EXPECT_EQ(bench.state().brightness, 66);
  bench.set("mute", "on");
  EXPECT_TRUE(bench.state().mute);
  bench.set("input", "hdmi2");
  EXPECT_EQ(bench.value("input"), "hdmi2");
  EXPECT_EQ(bench.value("hours"), "1234");
  EXPECT_EQ(bench.value("filter_hours"), "88");
  EXPECT_EQ(bench.value("errors"), "none");
}

TEST(HitachiBeef, TurnsTheLensAndRecallsIt) {
  ProjectorBench bench("hitachi-beef");
  bench.device().nudge("shift_v", 3);
  EXPECT_EQ(bench.state().lens.shiftV.place, 53);
  bench.host().with("p1", [](devices::SimulatedDevice& device, auto) {
    dynamic_cast<devices::ProjectorSimulator&>(device).state().lensMemory[1].zoom.place = 77;
  });
  bench.set("lens_memory", 2);
  EXPECT_EQ(bench.state().lens.zoom.place, 77);
  EXPECT_EQ(bench.value("lens_memory"), "2");
}

/// A projector at the network port of an address that no other process uses.
class NetworkBeef {
 public:
  NetworkBeef(const std::string& theirPassword, const std::string& ourPassword) {
    const int id = ::getpid();
    const std::string host = "127." + std::to_string(1 + id / 65536 % 250) + "." + std::to_string(id / 256 % 256) +
                             "." + std::to_string(id % 256);
    const std::string at = "tcp://" + host + ":9715";
    host_.add("p1", devices::makeHitachiBeefSimulator({.network = true, .password = theirPassword}),
              devices::parseLineAddress(at));
    device_ =
        devices::makeDevice(loop_, {.name = "p1.control", .driver = "hitachi-beef", .at = at, .password = ourPassword});
  }
  [[nodiscard]] devices::Device& device() { return *device_; }
  [[nodiscard]] devices::DeviceHost& host() { return host_; }

 private:
  devices::DeviceHost host_;
  devices::LineLoop loop_;
  std::unique_ptr<devices::Device> device_;
};

TEST(HitachiBeef, IsWrappedAtItsNetworkPort) {
  NetworkBeef open("", "");
  open.device().write("brightness", 70.0);
  EXPECT_EQ(devices::textOf(open.device().read("brightness")), "70");
  open.host().order("p1", devices::Fault::kCut);
  EXPECT_NE(complaintOf([&] { (void)open.device().read("brightness"); }), "");
  open.host().heal("p1");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!complaintOf([&] { (void)open.device().read("power"); }).empty()) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
  }
  EXPECT_EQ(devices::textOf(open.device().read("brightness")), "70");
}

TEST(HitachiBeef, ProvesThatItKnowsThePassword) {
  NetworkBeef guarded("sesame", "sesame");
  guarded.device().write("input", std::string("hdmi2"));
  EXPECT_EQ(devices::textOf(guarded.device().read("input")), "hdmi2");
}

TEST(HitachiBeef, SaysWhenThePasswordIsMissingOrWrong) {
  {
    NetworkBeef stranger("sesame", "");
    EXPECT_THAT(complaintOf([&] { (void)stranger.device().read("power"); }), HasSubstr("give control a password_file"));
  }
  NetworkBeef stranger("sesame", "simsim");
  EXPECT_THAT(complaintOf([&] { (void)stranger.device().read("power"); }), HasSubstr("it refuses the password"));
}

TEST(HitachiBeef, APasswordThatNobodyAsksForDoesNoHarm) {
  NetworkBeef open("", "sesame");
  EXPECT_EQ(devices::textOf(open.device().read("power")), "on");
}

TEST(HitachiBeef, SwitchesOffAndOn) {
  ProjectorBench bench("hitachi-beef?warm-up-ms=600&cool-down-ms=400");
  bench.set("power", "off");
  EXPECT_EQ(bench.value("power"), "off");
  EXPECT_THAT(complaintOf([&] { bench.set("brightness", 10); }), HasSubstr("is it switched on?"));
  bench.set("power", "on");
  bench.set("brightness", 62);
  EXPECT_EQ(bench.value("brightness"), "62");
}

TEST(HitachiBeef, AStuckSettingIsNamed) {
  ProjectorBench bench("hitachi-beef");
  EXPECT_EQ(bench.value("contrast"), "64");
  bench.host().order("p1", devices::Fault::kStuck);
  EXPECT_THAT(complaintOf([&] { bench.set("contrast", 66); }),
              HasSubstr("contrast stays at 64 instead of going to 66"));
}

class PjlinkLoginTest : public ::testing::TestWithParam<std::string> {};

TEST_P(PjlinkLoginTest, ControlsWithEveryLogin) {
  ProjectorBench bench("pjlink?password=secret&" + GetParam(), "secret");
  EXPECT_EQ(bench.value("power"), "on");
  bench.set("input", "video1");
  EXPECT_EQ(bench.state().input, 21);
  EXPECT_EQ(bench.value("input"), "video1");
  bench.set("mute", "on");
  EXPECT_TRUE(bench.state().mute);
  EXPECT_EQ(bench.value("hours"), "1234");
  EXPECT_EQ(bench.value("errors"), "none");
}

INSTANTIATE_TEST_SUITE_P(Versions, PjlinkLoginTest,
                         ::testing::Values("class=1&sha256=0", "class=2&sha256=0", "class=2&sha256=1"));

TEST(Pjlink, HasWhatItsClassHas) {
  EXPECT_EQ(ProjectorBench("pjlink?class=1").names(), "power input mute hours errors");
  EXPECT_EQ(ProjectorBench("pjlink?class=2").names(), "power input mute freeze hours filter_hours errors resolution");
}

TEST(Pjlink, SaysWhatItIs) {
  ProjectorBench bench("pjlink");
  EXPECT_EQ(bench.device().identity(), "PixelFlex Simulator Projector (PJLink class 2)");
  EXPECT_EQ(bench.value("resolution"), "1024x768");
  bench.set("freeze", "on");
  EXPECT_EQ(bench.value("freeze"), "on");
  bench.set("input", "network1");
  EXPECT_EQ(bench.state().input, 51);
}

TEST(Pjlink, AWrongPasswordIsTriedOnce) {
  ProjectorBench bench("pjlink?password=secret", "guess");
  EXPECT_THAT(complaintOf([&] { (void)bench.value("power"); }), HasSubstr("it refuses the password"));
  bench.host().order("p1", devices::Fault::kCut);  // it would be noticed if it were tried again
  EXPECT_THAT(complaintOf([&] { (void)bench.value("power"); }), HasSubstr("it refuses the password"));
}

TEST(Pjlink, AMissingPasswordIsAskedFor) {
  ProjectorBench bench("pjlink?password=secret");
  EXPECT_THAT(complaintOf([&] { (void)bench.value("power"); }), HasSubstr("give control a password_file"));
}

TEST(Pjlink, SwitchesOffAndOn) {
  ProjectorBench bench("pjlink?warm-up-ms=600&cool-down-ms=400");
  bench.set("power", "off");
  EXPECT_THAT(complaintOf([&] { bench.set("mute", "on"); }), HasSubstr("not now; it is in standby"));
  bench.set("power", "on");
  EXPECT_TRUE(bench.state().isOn());
}

TEST(EscVp21, ControlsAll) {
  ProjectorBench bench("escvp21");
  EXPECT_EQ(bench.names(),
            "power input mute brightness contrast red green blue zoom focus shift_h shift_v lens_memory hours errors");
  bench.set("brightness", 200);
  bench.set("red", 33);
  bench.set("mute", "on");
  bench.set("input", "video");
  bench.set("zoom", 12);
  bench.device().nudge("shift_h", -2);
  const auto state = bench.state();
  EXPECT_EQ(state.brightness, 200);
  EXPECT_EQ(state.gain[0], 33);
  EXPECT_TRUE(state.mute);
  EXPECT_EQ(state.input, 0x41);
  EXPECT_EQ(state.lens.zoom.place, 12);
  EXPECT_EQ(state.lens.shiftH.place, 48);
  EXPECT_EQ(bench.value("input"), "video");
  EXPECT_EQ(bench.value("hours"), "1234");
  EXPECT_EQ(bench.value("errors"), "none");
}

TEST(EscVp21, SwitchesOffAndOn) {
  ProjectorBench bench("escvp21?warm-up-ms=600&cool-down-ms=400");
  bench.set("power", "off");
  EXPECT_EQ(bench.value("power"), "off");
  EXPECT_THAT(complaintOf([&] { bench.set("brightness", 10); }), HasSubstr("is it switched on?"));
  bench.set("power", "on");
  EXPECT_EQ(bench.value("power"), "on");
}

TEST(Infocus, ReadsRangesAndVerifiesWhatItSets) {
  ProjectorBench bench("infocus");
  EXPECT_EQ(bench.names(), "power input mute brightness contrast red green blue zoom hours");
  const auto settings = bench.device().settings();
  const auto brightness = std::ranges::find(settings, "brightness", &devices::SettingInfo::name);
  EXPECT_EQ(brightness->minimum, 96);
  EXPECT_EQ(brightness->maximum, 160);
  bench.set("brightness", 150);
  bench.set("blue", 40);
  bench.set("mute", "on");
  bench.device().nudge("zoom", 4);
  const auto state = bench.state();
  EXPECT_EQ(state.brightness, 150);
  EXPECT_EQ(state.gain[2], 40);
  EXPECT_TRUE(state.mute);
  EXPECT_EQ(state.lens.zoom.place, 54);
  EXPECT_THAT(complaintOf([&] { bench.set("brightness", 200); }), HasSubstr("from 96 to 160"));
  EXPECT_THAT(complaintOf([&] { bench.set("zoom", 20); }), HasSubstr("zoom can only be read"));
}

TEST(Infocus, SwitchesOffAndOn) {
  ProjectorBench bench("infocus?warm-up-ms=600&cool-down-ms=400");
  bench.set("power", "off");
  EXPECT_EQ(bench.value("power"), "off");
  bench.set("power", "on");
  EXPECT_EQ(bench.value("power"), "on");
}

}  // namespace
}  // namespace pixelflex::testing
