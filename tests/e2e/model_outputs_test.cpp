// pixelflex model on an output that looks codes up itself.
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <memory>
#include <thread>

#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/dummy_xorg.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using devices::Image8;
using ::testing::HasSubstr;

using Tables = std::vector<std::uint16_t>;

/// A projector whose light is the third power of its codes, on the whole screen.
class ModelOutputsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(runProgram("new", {wall(), "--flat", "1x1:640x480"}).status, 0);
    calib::Wall made = calib::loadWall(wall());
    made.projectors[0].output = {.kind = calib::OutputKind::kDisplay, .display = screen_.display(), .at = {0, 0}};
    made.projectors[0].flatAt.reset();
    calib::saveWall(wall(), made);
    std::string rows;
    for (int i = 0; i < 256; ++i) {
      rows += std::to_string(i);
      for (int c = 0; c < 3; ++c) rows += "," + std::to_string(std::pow(i / 255.0, 3));
      rows += "\n";
    }
    writeText(folder_ / "wall" / "response.csv", rows);
    auto calibration = calib::loadCalibration(wall());
    calibration.projectors[0].flatAt.reset();
    calibration.projectors[0].response = "response.csv";
    calib::saveCalibration(wall(), calibration);
    writeText(folder_ / "solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }
  [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> all{wall(), (folder_ / "solid.obj").string(), "--view", "20,20"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void start(const std::vector<std::string>& more = {}) {
    auto all = command(more);
    all.insert(all.begin(), std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-model");
    viewer_ = std::make_unique<Process>(
        all, ProcessOptions{.environment = {"DISPLAY=" + screen_.display()}, .log = folder_ / "log"});
  }
  template <class Done>
  [[nodiscard]] static bool comesTrue(const Done& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done()) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }
  [[nodiscard]] Tables tables() const { return outputTables(screen_.display()); }
  [[nodiscard]] Image8 screen() const { return grabRoot(screen_.display()); }
  [[nodiscard]] bool showsModel() const {
    return std::ranges::any_of(screen().samples(), [](int code) { return code > 40; });
  }
  [[nodiscard]] std::string log() const { return textOf(folder_ / "log"); }
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }

  const TemporaryFolder folder_;
  XServer screen_{dummyXorg({640, 480})};
  const Tables before_ = tables();
  std::unique_ptr<Process> viewer_;
};

/// Codes that tables, as 16 bits, make of a picture, beside another's: the mean difference.
double differenceThrough(const Tables& tables, const Image8& shown, const Image8& expected) {
  const std::size_t entries = tables.size() / 3;
  double sum = 0;
  for (int y = 0; y < shown.height(); ++y) {
    for (int x = 0; x < shown.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto entry = static_cast<std::size_t>(shown.at(x, y, c)) * (entries - 1) / 255;
        sum += std::abs(tables[static_cast<std::size_t>(c) * entries + entry] / 257.0 - expected.at(x, y, c));
      }
    }
  }
  return sum / static_cast<double>(shown.samples().size());
}

TEST_F(ModelOutputsTest, TheOutputsTableTakesTheLastPassesPlaceUntilTheEnd) {
  ASSERT_FALSE(before_.empty());
  const auto shot = (folder_ / "shot").string();
  ASSERT_EQ(runProgram("model", command({"--headless", "--screenshot", shot})).status, 0);
  const Image8 expected = devices::readPng8(folder_ / "shot" / "p1.png");
  start({"--lut", "ramp"});
  ASSERT_TRUE(comesTrue([&] { return tables() != before_ && showsModel(); })) << log();
  const Tables ours = tables();
  const std::size_t entries = ours.size() / 3;
  for (std::size_t i = 0; i < entries; ++i) {
    const double code = static_cast<double>(i) / static_cast<double>(entries - 1);
    const double light = code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
    ASSERT_NEAR(ours[i] / 65535.0, std::cbrt(light), 0.01) << i;
  }
  EXPECT_LT(differenceThrough(ours, screen(), expected), 1.0);
  EXPECT_GT(differenceThrough(before_, screen(), expected), 1.0);
  viewer_->signal(SIGTERM);
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 0) << log();
  EXPECT_EQ(tables(), before_);
}

TEST_F(ModelOutputsTest, TheTableComesBackWhenTheProgramIsKilled) {
  start();
  ASSERT_TRUE(comesTrue([&] { return tables() != before_; })) << log();
  viewer_->signal(SIGKILL);
  EXPECT_TRUE(comesTrue([&] { return tables() == before_; }));
}

TEST_F(ModelOutputsTest, ThePassLeavesTheTableAlone) {
  start({"--lut", "pass"});
  ASSERT_TRUE(comesTrue([&] { return showsModel(); })) << log();
  EXPECT_EQ(tables(), before_);
}

TEST_F(ModelOutputsTest, WhereNoOutputShowsJustTheWindowTheRampIsRefused) {
  calib::Wall aside = calib::loadWall(wall());
  aside.projectors[0].output.at = {10, 0};
  calib::saveWall(wall(), aside);
  start({"--lut", "ramp"});
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 1);
  EXPECT_THAT(log(), HasSubstr("p1: no output shows just its window and has a gamma ramp"));
  EXPECT_EQ(tables(), before_);
}

}  // namespace
}  // namespace pixelflex::testing
