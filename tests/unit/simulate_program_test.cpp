#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using ::testing::HasSubstr;
using ::testing::Not;

class SimulateProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    const Rig rig = miniRig(2);
    devices::writeFileAtomically(wall() / "rig.yaml", formatRig(rig));
    saveWall(wall(), wallOfRig(rig, "rig.yaml"));
    std::filesystem::create_directories(frames());
    for (const char* name : {"p1.png", "p2.png"}) writeFrame(name, {640, 480});
  }

  [[nodiscard]] std::filesystem::path wall() const { return folder_.path() / "wall"; }
  [[nodiscard]] std::filesystem::path frames() const { return folder_.path() / "frames"; }
  [[nodiscard]] std::filesystem::path picture() const { return folder_.path() / "out" / "audience.png"; }

  void writeFrame(const std::string& name, devices::Size size) const {
    Image8 image(size, 3);
    std::ranges::fill(image.samples(), std::uint8_t{200});
    devices::writePng(frames() / name, image);
  }

  [[nodiscard]] static testing::Output simulate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-simulate");
    return testing::run(arguments);
  }

  [[nodiscard]] testing::Output compose(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{wall().string(), "--frames", frames().string(), "--audience",
                                       picture().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return simulate(arguments);
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(SimulateProgram, ComposesTheFrames) {
  const auto output = compose({"--size", "600x400"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_EQ(output.text, "");
  const Image8 image = devices::readPng8(picture());
  EXPECT_EQ(image.size(), (devices::Size{600, 400}));
  EXPECT_GT(image.at(300, 200, 1), 100);
  EXPECT_LT(image.at(3, 3, 1), 40);
}

TEST_F(SimulateProgram, ShowsMissingFramesBlackAndSaysSo) {
  std::filesystem::remove(frames() / "p2.png");
  const auto output = compose({"--size", "600x400"});
  EXPECT_EQ(output.status, 0);
  EXPECT_THAT(output.text, HasSubstr("p2.png is missing"));
  EXPECT_THAT(output.text, Not(HasSubstr("p1.png")));
  const Image8 image = devices::readPng8(picture());
  EXPECT_GT(image.at(180, 200, 1), 100);
  EXPECT_LT(image.at(420, 200, 1), 60);
}

TEST_F(SimulateProgram, RefusesAFrameOfAnotherSize) {
  writeFrame("p2.png", {100, 80});
  const auto output = compose();
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("pixelflex-simulate: "));
  EXPECT_THAT(output.text, HasSubstr("p2.png: this frame has 100x80 pixels"));
  EXPECT_FALSE(std::filesystem::exists(picture()));
}

TEST_F(SimulateProgram, ShowsTheDisplayRectangleOfACalibratedWall) {
  Calibration calibration;
  calibration.display = Display{600, 500, 1800, 1100, {1200, 600}};
  saveCalibration(wall(), calibration);
  ASSERT_EQ(compose({"--margin", "0"}).status, 0);
  EXPECT_EQ(devices::readPng8(picture()).size(), (devices::Size{2400, 1200}));
  ASSERT_EQ(compose({"--margin", "10", "--size", "300x300"}).status, 0);
  const Image8 image = devices::readPng8(picture());
  EXPECT_GT(image.at(150, 150, 1), 100);
}

TEST_F(SimulateProgram, ShowsAnUncalibratedWall) {
  writeFrame("desktop.png", {800, 300});
  const auto output = simulate({wall().string(), "--uncalibrated", (frames() / "desktop.png").string(), "--audience",
                                picture().string(), "--size", "500x330"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_GT(devices::readPng8(picture()).at(250, 165, 1), 100);
}

TEST_F(SimulateProgram, UnrollsACurvedScreen) {
  const Rig rig = cylinderRig(1);
  devices::writeFileAtomically(wall() / "rig.yaml", formatRig(rig));
  saveWall(wall(), wallOfRig(rig, "rig.yaml"));
  for (const auto& projector : rig.projectors) {  // a white square in the middle of each frame
    Image8 frame(projector.resolution, 3);
    for (int y = 500; y < 580; ++y) {
      for (int x = 920; x < 1000; ++x) frame.at(x, y, 1) = 255;
    }
    devices::writePng(frames() / (projector.name + ".png"), frame);
  }
  const devices::Size size{static_cast<int>(rig.screenSize.x / 4), static_cast<int>(rig.screenSize.y / 4)};
  ASSERT_EQ(compose({"--size", std::to_string(size.width) + "x" + std::to_string(size.height)}).status, 0);
  const Image8 image = devices::readPng8(picture());
  const SimulatedWall truth(rig);
  for (std::size_t i = 0; i < rig.projectors.size(); ++i) {
    const glm::dvec2 square = truth.wallFromProjector(i, {960, 540}).value() / 4.0;
    EXPECT_GT(image.at(static_cast<int>(square.x), static_cast<int>(square.y), 1), 150);
    EXPECT_LT(image.at(static_cast<int>(square.x) + 16, static_cast<int>(square.y), 1), 60);
    EXPECT_LT(image.at(static_cast<int>(square.x) - 16, static_cast<int>(square.y), 1), 60);
  }
}

TEST_F(SimulateProgram, SaysWhatIsWrongWithTheWall) {
  auto plain = parseWall(formatWall(wallOfRig(miniRig(2), "rig.yaml")), "wall.yaml");
  std::filesystem::remove(wall() / "rig.yaml");
  EXPECT_EQ(compose().status, 1);
  EXPECT_THAT(compose().text, HasSubstr("rig.yaml"));
  plain.rig.reset();
  plain.camera.source = "photos";
  for (auto& projector : plain.projectors) projector.output.kind = OutputKind::kNone;
  saveWall(wall(), plain);
  const auto output = compose();
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("this wall is not simulated"));
}

TEST_F(SimulateProgram, KnowsItsUsage) {
  EXPECT_EQ(simulate({"--help"}).status, 0);
  EXPECT_THAT(simulate({"--help"}).text, HasSubstr("--uncalibrated"));
  EXPECT_THAT(simulate({"--version"}).text, HasSubstr("pixelflex-simulate "));
  EXPECT_EQ(simulate({wall().string()}).status, 2);
  EXPECT_EQ(simulate({}).status, 2);
  EXPECT_EQ(compose({"--size", "12"}).status, 2);
  EXPECT_EQ(compose({"--uncalibrated", "desktop.png"}).status, 2);
}

}  // namespace
}  // namespace pixelflex::calib
