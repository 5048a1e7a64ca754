#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using calib::DeviceLine;

calib::Wall wallWith(const DeviceLine& control, const DeviceLine& mirror) {
  calib::Wall wall;
  wall.camera.source = "none";
  calib::ProjectorConfig first;
  first.name = "p1";
  first.resolution = {64, 64};
  first.flatAt = {0, 0};
  calib::ProjectorConfig second = first;
  second.name = "p2";
  second.control = control;
  second.mirror = mirror;
  wall.projectors = {first, second};
  return wall;
}

TEST(StoreDevices, APasswordFileIsKept) {
  const calib::Wall wall = wallWith({"pjlink", "tcp://10.0.0.5:4352", "secrets/p 2"}, {"ptu", "sim:ptu", {}});
  EXPECT_EQ(calib::parseWall(calib::formatWall(wall), "wall.yaml"), wall);
}

TEST(StoreDevices, ListsThemWithPathsThatHoldEverywhere) {
  const TemporaryFolder folder;
  const auto devices = calib::devicesOf(
      wallWith({"pjlink", "tcp://10.0.0.5:4352", "secret"}, {"ptu", "serial:lines/p2?baud=1200", {}}), folder.path());
  ASSERT_EQ(devices.size(), 2U);
  EXPECT_EQ(devices[0].name, "p2.control");
  EXPECT_FALSE(devices[0].isMirror);
  EXPECT_EQ(devices[1].name, "p2.mirror");
  EXPECT_EQ(devices[1].projector, "p2");
  EXPECT_EQ(devices[1].line.at, "serial:" + folder.path().string() + "/lines/p2?baud=1200");
  EXPECT_THROW((void)calib::passwordOf(devices[0]), calib::StoreError);
  std::ofstream(folder / "secret") << "pass word\r\nmore\n";
  EXPECT_EQ(calib::passwordOf(devices[0]), "pass word");
  EXPECT_EQ(calib::passwordOf(devices[1]), "");
}

TEST(StoreDevices, AbsolutePathsStay) {
  const auto devices =
      calib::devicesOf(wallWith({"escvp21", "serial:/dev/ttyUSB0", {}}, {"ptu", "serial:/dev/ttyS1", {}}), "wall");
  EXPECT_EQ(devices[0].line.at, "serial:/dev/ttyUSB0");
}

}  // namespace
}  // namespace pixelflex::testing
