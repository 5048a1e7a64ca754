// Devices, projectors and a camera in one simulated room, each reached by its own protocol.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/simulate/rig.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/registration.h"
#include "tests/support_devices/gige_place.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using calib::ErrorFigures;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ServedRoomTest : public ::testing::Test {
 protected:
  /// The wall of the small rig with a third projector in the middle; each projector has a control and a mirror at
  /// serial lines, and the camera is on the network.
  void serve() {
    calib::Rig rig = calib::loadRig(kMiniRig);
    calib::SimulatedProjectorSpec third = rig.projectors.front();
    third.name = "p3";
    third.pose.position += glm::dvec3(430, 20, 60);
    third.pose.rotation.z += 1.5;
    rig.projectors.push_back(third);
    const std::string file = (folder_ / "three.yaml").string();
    writeText(file, formatRig(rig));
    ASSERT_EQ(runProgram("new", {wall(), "--rig", file}).status, 0);
    calib::Wall made = calib::loadWall(wall());
    made.camera.source = "aravis:" + place_.address;
    for (auto& projector : made.projectors) {
      projector.control = {"hitachi-beef", "serial:" + line(projector.name + ".control"), {}};
      projector.mirror = {"ptu", "serial:" + line(projector.name + ".mirror"), {}};
    }
    saveWall(wall(), made);
    server_ = std::make_unique<Process>(std::vector<std::string>{std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-simulate",
                                                                 wall(), "--serve", "--faster", "50"},
                                        ProcessOptions{.log = log()});
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!textOf(log()).ends_with("Ctrl+C ends it\n")) {
      ASSERT_TRUE(server_->running()) << textOf(log());
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << textOf(log());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }
  [[nodiscard]] fs::path log() const { return folder_ / "served.txt"; }
  [[nodiscard]] std::string line(const std::string& name) const { return (folder_ / "lines" / name).string(); }

  [[nodiscard]] Output onWall(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), wall());
    return runProgram(program, arguments);
  }
  [[nodiscard]] devices::Image8 shot() const {
    const std::string file = (folder_ / "shot.png").string();
    const Output output = runProgram("camera", {"shot", wall(), "-o", file, "--exposure", "0.03"});
    EXPECT_EQ(output.status, 0) << output.text;
    return devices::readPng8(file);
  }
  /// How far every desktop point that the calibration shows lands from where it should, in the room as it is.
  [[nodiscard]] ErrorFigures registration() const {
    (void)shot();  // after which the room's rig.yaml is the room as it is
    const calib::SimulatedWall room(calib::loadRig(fs::path(wall()) / "room" / "rig.yaml"));
    const auto calibration = calib::loadCalibration(wall());
    std::vector<calib::ProjectorMapping> mappings;
    for (const auto& projector : calibration.projectors) mappings.emplace_back(projector.model, projector.resolution);
    return measureRegistration(room,
                               [&](std::size_t i, glm::dvec2 point) -> std::optional<glm::dvec2> {
                                 return mappings.at(i).wallFromProjector(point);
                               })
        .all;
  }

  TemporaryFolder folder_;
  GigePlace place_;
  std::unique_ptr<Process> server_;
};

double meanOf(const devices::Image8& photo) {
  double sum = 0;
  for (const auto code : photo.samples()) sum += code;
  return sum / static_cast<double>(photo.samples().size());
}

TEST_F(ServedRoomTest, WhatIsShownIsSeenUnlessTheProjectorIsMutedOrOff) {
  serve();
  const double dark = meanOf(shot());
  devices::Image8 white({640, 480}, 1);
  std::ranges::fill(white.samples(), std::uint8_t{255});
  devices::writePng(fs::path(wall()) / "room" / "p1.png", white);
  const double lit = meanOf(shot());
  EXPECT_GT(lit, dark + 10);
  ASSERT_EQ(onWall("device", {"p1", "mute=on"}).status, 0);
  EXPECT_NEAR(meanOf(shot()), dark, 0.5);
  ASSERT_EQ(onWall("device", {"p1", "mute=off"}).status, 0);
  EXPECT_NEAR(meanOf(shot()), lit, 0.5);
  ASSERT_EQ(onWall("device", {"p1", "contrast=32"}).status, 0);
  EXPECT_LT(meanOf(shot()), 0.7 * lit);
  ASSERT_EQ(onWall("device", {"p1,p2", "power=off"}).status, 0);
  EXPECT_LT(meanOf(shot()), dark);
}

TEST_F(ServedRoomTest, PresetsComeBackToTheRightPicture) {
  serve();
  const Output calibrated = onWall("calibrate", {});
  ASSERT_EQ(calibrated.status, 0) << calibrated.text;
  EXPECT_LT(registration().rms, 0.05);
  ASSERT_EQ(onWall("preset", {"save", "a"}).status, 0);

  ASSERT_EQ(onWall("device", {"p1.mirror", "pan=0.8", "tilt=-0.4"}).status, 0);
  ASSERT_EQ(onWall("device", {"p2.mirror", "pan=-0.6", "tilt=0.3"}).status, 0);
  ASSERT_EQ(onWall("device", {"p3.mirror", "pan=0.5"}).status, 0);
  ASSERT_EQ(onWall("device", {"p2.control", "zoom+=8"}).status, 0);
  EXPECT_GT(registration().rms, 5);
  const Output checked = onWall("calibrate", {"--check"});
  EXPECT_THAT(checked.text, AllOf(HasSubstr("--only p1"), HasSubstr("--only p2"), HasSubstr("--only p3")))
      << checked.text;
  const Output again = onWall("calibrate", {"--only", "p1,p2,p3"});
  ASSERT_EQ(again.status, 0) << again.text;
  EXPECT_LT(registration().rms, 0.05) << again.text;
  ASSERT_EQ(onWall("preset", {"save", "b"}).status, 0);

  // The mirrors come back by themselves. Nobody can ask where a zoom stands: that the camera sees.
  const Output verified = onWall("preset", {"restore", "a", "--verify"});
  EXPECT_EQ(verified.status, 0) << verified.text;
  EXPECT_THAT(verified.text, AllOf(HasSubstr("in place"), HasSubstr("--only p2"), Not(HasSubstr("--only p1")),
                                   Not(HasSubstr("--only p3"))));
  const Output cured = onWall("preset", {"restore", "a", "--recalibrate", "1"});
  EXPECT_EQ(cured.status, 0) << cured.text;
  EXPECT_THAT(cured.text, HasSubstr("measured again: p2\n"));
  EXPECT_LT(registration().rms, 0.05) << cured.text;
  EXPECT_THAT(onWall("preset", {"restore", "b", "--verify"}).text, Not(HasSubstr("--only")));
  EXPECT_LT(registration().rms, 0.05);
}

}  // namespace
}  // namespace pixelflex::testing
