// gamma: camera, as people use it: live, again from captures/, and from photographs made by hand.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "calib/patterns/response_pattern.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/readings_file.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

constexpr double kFloor = 0.01;  // of white: below it errors are relative to this

/// Two projectors before a camera that is not linear; nothing is measured yet.
class CalibrateResponseTest : public ::testing::Test {
 protected:
  void SetUp() override {
    rig_.camera.gamma = cameraGamma();
    writeText(folder_ / "rig.yaml", calib::formatRig(rig_));
    ASSERT_EQ(runProgram("new", {wall().string(), "--rig", (folder_ / "rig.yaml").string()}).status, 0);
  }
  [[nodiscard]] virtual double cameraGamma() const { return 2.2; }
  /// From now on the camera measures p1.
  void useCameraForGamma() const {
    const std::string text = textOf(wall() / "wall.yaml");
    writeText(wall() / "wall.yaml", replaced(text, "\n    gamma: readings/p1.csv", "\n    gamma: camera"));
    ASSERT_TRUE(calib::loadWall(wall()).projectors[0].gammaByCamera);
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] fs::path photos() const { return folder_ / "photos"; }
  [[nodiscard]] Output calibrate(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all = {wall().string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return runProgram("calibrate", all);
  }

  /// Relative, RMS over codes 20 to 235, of what is stored against the rig.
  [[nodiscard]] double errorOfResponse() const {
    const calib::SimulatedWall room(rig_);
    const std::string file = *calib::loadCalibration(wall()).projectors[0].response;
    const auto found = calib::readReadings(textOf(wall() / file), file);
    EXPECT_TRUE(found.problems.empty());
    double squares = 0;
    for (int c = 0; c < 3; ++c) {
      const double black = room.light(0, c, 0);
      for (std::size_t code = 20; code <= 235; ++code) {
        const double truth = (room.light(0, c, double(code) / 255) - black) / (room.light(0, c, 1) - black);
        squares += std::pow((found.light[static_cast<std::size_t>(c)][code] - truth) / std::max(truth, kFloor), 2);
      }
    }
    return std::sqrt(squares / (3 * 216));
  }

  /// Photographs p1 by hand: a name and an exposure (in usual ones) for every pattern.
  using Naming = std::function<std::string(const std::string& pattern, double exposure)>;
  void photographByHand(calib::SimulatedWall& room, const Naming& name,
                        const std::function<double(const std::string&)>& exposure) const {
    devices::ExposureControl& control = *room.camera().exposureControl();
    ASSERT_TRUE(room.person().arrange(devices::Scene::kDark, 0));
    const double usual = control.exposure();
    for (const auto& pattern : calib::responsePatterns(room.projector(0).resolution())) {
      if (pattern.name == "response-chart") continue;
      room.projector(0).show(pattern.render());
      control.setExposure(usual * exposure(pattern.name));
      devices::writePng(photos() / "p1" / (name(pattern.name, control.exposure()) + ".png"), room.camera().shoot());
    }
  }

  /// As the instructions say it.
  static double exposureFor(const std::string& pattern) {
    if (pattern == "response-black") return 64;
    const int code = std::stoi(pattern.substr(pattern.find('-') + 1));
    return code >= 128 ? 1 : code >= 56 ? 4 : code >= 32 ? 16 : 64;
  }

  /// The gamma step from spoiled photographs must fail with these words and change nothing.
  void expectRefused(const std::vector<std::string>& words) const {
    const std::string before = textOf(wall() / "calibration.yaml");
    const Output run = calibrate({"gamma", "--photos", photos().string()});
    EXPECT_EQ(run.status, 1) << run.text;
    for (const auto& word : words) EXPECT_THAT(run.text, HasSubstr(word));
    EXPECT_TRUE(textOf(wall() / "calibration.yaml") == before) << "the store has changed";
  }

  calib::Rig rig_ = calib::casualRig(2, 1, {320, 240}, 5, {640, 360});
  const TemporaryFolder folder_;
};

TEST_F(CalibrateResponseTest, MeasuresLiveThroughACameraThatIsNotLinear) {
  useCameraForGamma();
  const Output run = calibrate({});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, HasSubstr("2 responses, by camera to 0."));
  const auto live = calib::loadCalibration(wall());
  const auto& p1 = live.projectors[0];
  ASSERT_TRUE(p1.response && p1.responseError && p1.leak && live.camera->response);
  EXPECT_LT(*p1.responseError, 0.015);
  EXPECT_LT(errorOfResponse(), 0.015);
  const double black = rig_.projectors[0].response.black;
  EXPECT_NEAR(*p1.leak, black / (1 - black), 0.05 * black);
  EXPECT_FALSE(live.projectors[1].responseError);
  EXPECT_TRUE(calib::checkWall(wall()).empty());
  EXPECT_THAT(calibrate({}).text, HasSubstr("nothing has changed"));

  // The same from its own captures, where the photographs of geometry are as well.
  const Output again = calibrate({"--all", "--photos", (wall() / "captures").string()});
  ASSERT_EQ(again.status, 0) << again.text;
  const auto offline = calib::loadCalibration(wall()).projectors[0];
  EXPECT_NEAR(*offline.responseError, *p1.responseError, 1e-4);
  EXPECT_NEAR(*offline.leak, *p1.leak, 1e-4);
  EXPECT_LT(errorOfResponse(), 0.015);

  // A repair of the other projector leaves this one's response alone.
  const Output repair = calibrate({"--only", "p2"});
  ASSERT_EQ(repair.status, 0) << repair.text;
  EXPECT_THAT(repair.text, Not(HasSubstr("by camera")));
  const auto repaired = calib::loadCalibration(wall()).projectors[0];
  EXPECT_EQ(repaired.response, offline.response);
  EXPECT_EQ(repaired.responseError, offline.responseError);
  EXPECT_EQ(repaired.leak, offline.leak);
}

TEST_F(CalibrateResponseTest, GammaAloneKeepsThePhotographsOfGeometry) {
  ASSERT_EQ(calibrate({}).status, 0);
  const auto files = [this] {
    std::set<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(wall() / "captures")) found.insert(entry.path());
    return found;
  };
  const auto before = files();
  useCameraForGamma();
  const Output run = calibrate({});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_THAT(run.text, Not(HasSubstr("projectors 2 projectors")));
  const auto after = files();
  EXPECT_TRUE(std::ranges::includes(after, before));
  EXPECT_GT(after.size(), before.size() + 97);
}

/// Photographs made by hand, with a linear camera.
class ByHandTest : public CalibrateResponseTest {
 protected:
  void SetUp() override {
    CalibrateResponseTest::SetUp();
    ASSERT_EQ(calibrate({}).status, 0);
    useCameraForGamma();
    calib::Wall changed = calib::loadWall(wall());
    changed.blend.uniformity.reset();  // only the response is photographed
    changed.blend.evenBlack = false;
    calib::saveWall(wall(), changed);
    room_ = std::make_unique<calib::SimulatedWall>(rig_);
  }
  [[nodiscard]] double cameraGamma() const override { return 1; }
  void photograph() {
    photographByHand(
        *room_, [](const std::string& pattern, double seconds) { return pattern + "@" + std::to_string(seconds); },
        exposureFor);
  }
  /// The photograph of a pattern, whatever its exposure.
  [[nodiscard]] fs::path photoOf(const std::string& pattern) const {
    for (const auto& entry : fs::directory_iterator(photos() / "p1")) {
      if (entry.path().filename().string().starts_with(pattern + "@")) return entry.path();
    }
    throw std::runtime_error("no photograph of " + pattern);
  }
  std::unique_ptr<calib::SimulatedWall> room_;
};

TEST_F(ByHandTest, TheInstructionsExposuresAreEnough) {
  photograph();
  const Output run = calibrate({"gamma", "--photos", photos().string()});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_LT(errorOfResponse(), 0.015);
  EXPECT_LT(*calib::loadCalibration(wall()).projectors[0].responseError, 0.015);
  EXPECT_TRUE(fs::exists(wall() / "captures/p1" / photoOf("red-064").filename()));
  EXPECT_TRUE(fs::exists(wall() / "captures/p1/white.png"));
}

TEST_F(ByHandTest, OneExposureIsEnoughForALinearCameraAndItSaysWhatThatCosts) {
  photographByHand(
      *room_, [](const std::string& pattern, double) { return pattern; }, [](const std::string&) { return 1; });
  const Output run = calibrate({"gamma", "--photos", photos().string()});
  ASSERT_EQ(run.status, 0) << run.text;
  const double told = *calib::loadCalibration(wall()).projectors[0].responseError;
  const double error = errorOfResponse();
  EXPECT_LT(error, 0.08);
  EXPECT_GT(told, 0.3 * error);
  EXPECT_LT(told, 3 * error);
  EXPECT_FALSE(calib::loadCalibration(wall()).projectors[0].leak) << "black is too dark in that one photograph";
  std::printf("one exposure: %.2f %% RMS (told %.2f %%)\n", 100 * error, 100 * told);
}

TEST_F(ByHandTest, BadPhotographsAreNamed) {
  photograph();
  const fs::path missing = photoOf("green-064");
  const fs::path aside = folder_ / "aside.png";
  fs::rename(missing, aside);
  expectRefused({"p1/green-064.png", "missing"});

  fs::rename(aside, photos() / "p1/green-064.png");
  expectRefused({"p1/green-064.png", "exposure is not told"});
  fs::rename(photos() / "p1/green-064.png", missing);

  const fs::path blue = photoOf("blue-255");
  fs::copy_file(blue, aside);
  devices::Image8 bright = devices::readPng8(blue);
  for (auto& sample : bright.samples()) sample = static_cast<std::uint8_t>(std::min(255, 5 * sample));
  devices::writePng(blue, bright);
  expectRefused({"p1/blue-255", "over-exposed"});
  fs::rename(aside, blue);

  const fs::path red = photoOf("red-199");
  const fs::path other = photoOf("red-135");
  fs::rename(red, aside);
  fs::rename(other, red);
  fs::rename(aside, other);
  expectRefused({"projector p1: p1/red-1", "light falls where codes rise", "mixed up"});
  fs::rename(red, aside);
  fs::rename(other, red);
  fs::rename(aside, other);

  EXPECT_EQ(calibrate({"gamma", "--photos", photos().string()}).status, 0) << "all is put right again";

  fs::remove_all(photos());
  fs::create_directories(photos() / "p1");
  fs::copy(wall() / "captures/p1/white.png", photos() / "p1/white.png");
  expectRefused({"p1/red-255", "--patterns DIR"});
}

TEST_F(CalibrateResponseTest, PatternsAreWrittenForTheProjectorsThatNeedThem) {
  useCameraForGamma();
  const fs::path patterns = folder_ / "patterns";
  const Output run = calibrate({"--patterns", patterns.string()});
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_TRUE(fs::exists(patterns / "p1/red-008.png"));
  EXPECT_TRUE(fs::exists(patterns / "p1/response-black.png"));
  EXPECT_FALSE(fs::exists(patterns / "p2/red-008.png"));
  EXPECT_THAT(textOf(patterns / "README.txt"), HasSubstr("The response of p1\n"));
}

}  // namespace
}  // namespace pixelflex::testing
