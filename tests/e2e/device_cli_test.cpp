#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "calib/store/store.h"
#include "tests/e2e/device_room.h"
#include "tests/e2e/programs.h"
#include "tests/support/free_port.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_devices/bridges.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

using DeviceCliTest = DeviceRoomTest;

TEST_F(DeviceCliTest, ListsReadsAndSets) {
  makeRoom(2, 20);
  const Output list = device({});
  EXPECT_EQ(list.status, 0) << list.text;
  EXPECT_THAT(list.text, HasSubstr("p1.control  proxima-dp6850  tcp://127.0.0.1:"));
  EXPECT_THAT(list.text, HasSubstr("power on, input rgb1, mute off"));
  EXPECT_THAT(list.text, HasSubstr("pan 0 deg, tilt 0 deg"));
  EXPECT_EQ(device({"p1,p2.mirror", "pan=12.5", "tilt_counts=-60", "brightness=80", "mute=on"}).status, 0);
  EXPECT_EQ(pan("p1.mirror").position, 243);
  EXPECT_EQ(pan("p2.mirror").position, 243);
  EXPECT_EQ(device({"p1", "pan_counts", "brightness", "mute"}).text,
            "p1.control  brightness  80\np1.control  mute        on\np1.mirror   pan_counts  243 counts\n");
  EXPECT_EQ(device({"p1", "pan_counts-=3", "pan_counts"}).text, "p1.mirror  pan_counts  240 counts\n");
  EXPECT_EQ(device({"all", "home"}).status, 0);
  EXPECT_EQ(pan("p2.mirror").position, 0);
}

TEST_F(DeviceCliTest, SpeaksJson) {
  makeRoom(1);
  const Output output = device({"p1", "--json", "brightness", "power", "pan"});
  EXPECT_EQ(output.status, 0);
  EXPECT_THAT(output.text, HasSubstr(R"("device": "p1.control", "driver": "proxima-dp6850", "at": "tcp://127.0.0.1:)"));
  EXPECT_THAT(output.text, HasSubstr(R"("ok": true, "values": {"brightness": 64, "power": "on"}})"));
  EXPECT_THAT(output.text, HasSubstr(R"("values": {"pan": 0}})"));
  host_.order("p1.control", Fault::kCut);
  const Output broken = device({"p1.control", "--json", "brightness"});
  EXPECT_EQ(broken.status, 1);
  EXPECT_THAT(broken.text, HasSubstr(R"("ok": false, "error": "p1.control at tcp://127.0.0.1:)"));
}

TEST_F(DeviceCliTest, SaysWhatIsWrong) {
  makeRoom(1, 20);
  const std::vector<std::pair<std::vector<std::string>, std::string>> usages = {
      {{"p9"}, "\"p9\" is no device of this wall; there are p1.control, p1.mirror"},
      {{"p1", "PAN=3"}, "\"PAN=3\": write SETTING=VALUE"},
      {{"p1", "pan+=x"}, "a number belongs behind += and -="},
      {{"p1.control", "pan=3"}, "\"pan=3\" is for a mirror, and p1.control has none"}};
  for (const auto& [arguments, message] : usages) {
    const Output output = device(arguments);
    EXPECT_EQ(output.status, 2) << output.text;
    EXPECT_THAT(output.text, HasSubstr("pixelflex-device: "));
    EXPECT_THAT(output.text, HasSubstr(message));
  }
  const Output outside = device({"p1", "pan=200"});
  EXPECT_EQ(outside.status, 1);
  EXPECT_THAT(outside.text, HasSubstr("pixelflex-device: p1.mirror: pan=200: it can be a number from -158.9142"));
  EXPECT_THAT(device({"p1", "sharpness=3"}).text, HasSubstr("p1.control has no setting \"sharpness\", only power, "));
  EXPECT_EQ(pan("p1.mirror").position, 0);
}

// The report's room: sixteen lines.
TEST_F(DeviceCliTest, EightMirrorsMoveInTheTimeOfTheSlowestAndOneDeadLineIsOneBadRow) {
  makeRoom(8);
  // One after the other they would take eight times so long.
  const auto begun = Clock::now();
  const Output move = device({"all", "pan_counts=2000"});
  const auto took = Clock::now() - begun;
  EXPECT_EQ(move.status, 0) << move.text;
  for (int i = 1; i <= 8; ++i) EXPECT_EQ(pan("p" + std::to_string(i) + ".mirror").position, 2000);
  EXPECT_LT(took, std::chrono::seconds(8));  // 2 s for the way at 1000 counts/s
  host_.order("p3.mirror", Fault::kCut);
  const Output list = device({});
  EXPECT_EQ(list.status, 1);
  EXPECT_THAT(list.text, HasSubstr("ERROR: p3.mirror at tcp://127.0.0.1:"));
  EXPECT_THAT(list.text, HasSubstr("no connection: Connection refused"));
  std::size_t good = 0;
  for (auto at = list.text.find("pan 102.8"); at != std::string::npos; at = list.text.find("pan 102.8", at + 1)) ++good;
  EXPECT_EQ(good, 7U);
}

class DeviceKillTest : public DeviceCliTest, public ::testing::WithParamInterface<int> {};

// Whatever ends the program: no mirror turns on.
TEST_P(DeviceKillTest, NoMirrorIsLeftMoving) {
  makeRoom(2, 0.02);
  Process process({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-device", folder(), "all", "pan=150"});
  ASSERT_TRUE(comesTo(true, "p1.mirror"));
  ASSERT_TRUE(comesTo(true, "p2.mirror"));
  process.signal(GetParam());
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_TRUE(comesTo(false, "p2.mirror"));
  EXPECT_LT(pan("p1.mirror").position, 2900);  // halted on its way, not arrived
  EXPECT_TRUE(process.wait(std::chrono::seconds(60)).has_value());
}

INSTANTIATE_TEST_SUITE_P(Signals, DeviceKillTest, ::testing::Values(SIGTERM, SIGINT, SIGHUP, SIGKILL, SIGSEGV));

TEST_F(DeviceCliTest, SimulateServesTheDevicesOfAWall) {
  calib::Wall wall;
  wall.camera.source = "none";
  calib::ProjectorConfig projector;
  projector.name = "p1";
  projector.resolution = {1024, 768};
  projector.flatAt = {0, 0};
  const int port = freePort();
  projector.control = {"pjlink", "tcp://127.0.0.1:" + std::to_string(port), "secret"};
  projector.mirror = {"ptu", "serial:lines/p1", {}};
  wall.projectors = {projector};
  writeText(folder() + "/secret", "JBMIAProjectorLink\n");
  saveWall(folder(), wall);
  Process server(
      {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-simulate", folder(), "--serve", "--fault", "p1.mirror=stuck"},
      {.log = folder_ / "log"});
  waitForPort(port);
  const Output power = device({"p1", "power", "pan"});
  EXPECT_EQ(power.text, "p1.control  power  on\np1.mirror   pan    0 deg\n") << textOf(folder_ / "log");
  EXPECT_THAT(device({"p1", "pan=10"}).text, HasSubstr("is it blocked?"));
  server.signal(SIGTERM);
  EXPECT_EQ(server.wait(std::chrono::seconds(60)), 0);
  EXPECT_FALSE(std::filesystem::exists(folder() + "/lines/p1"));
}

TEST_F(DeviceCliTest, CheckFindsDevicesThatCannotBe) {
  makeRoom(1);
  const std::string file = folder() + "/wall.yaml";
  std::string text = textOf(file);
  text = replaced(text, "proxima-dp6850", "toaster");
  text = replaced(text, "driver: ptu, at: \"tcp://127.0.0.1", "driver: pjlink, at: \"tcp:127.0.0.1");
  writeText(file, text);
  const Output output = runProgram("check", {folder()});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("there is no such driver of projectors: hitachi-legacy, proxima-dp6850"));
  EXPECT_THAT(output.text, HasSubstr("a mirror's driver is ptu"));
}

}  // namespace
}  // namespace pixelflex::testing
