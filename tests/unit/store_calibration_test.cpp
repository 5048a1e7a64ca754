#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "calib/store/store.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

using calib::formatCalibration;
using calib::parseCalibration;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

calib::Calibration exampleCalibration() {
  return parseCalibration(dataFile("calibration-v1.yaml"), "calibration.yaml");
}

std::string exampleWith(const std::string& from, const std::string& to) {
  std::string text = dataFile("calibration-v1.yaml");
  const std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::runtime_error("no such text in the example: " + from);
  return text.replace(place, from.size(), to);
}

TEST(StoreCalibration, ReadsEveryKey) {
  const calib::Calibration calibration = exampleCalibration();
  EXPECT_EQ(calibration.camera,
            (calib::CameraIntrinsics{
                {1920, 1080}, 1500.25, 1499.75, 960.5, 540.5, {-0.1, 0.02, 0}, {0.0001, -0.0002}, 0.125, 15}));
  EXPECT_EQ(calibration.surface, (calib::SurfaceFit{{1.6, 0.01, -20, 0.02, 1.7, -30, 1e-06, 2e-06, 1}, 0.25}));
  EXPECT_EQ(calibration.display, (calib::Display{100, 50, 2900, 1450, {2000, 1000}}));
  ASSERT_EQ(calibration.projectors.size(), 2U);
  const auto& p1 = calibration.projectors[0];
  EXPECT_EQ(p1.name, "p1");
  EXPECT_EQ(p1.resolution, (devices::Size{1024, 768}));
  EXPECT_THAT(p1.samples, ElementsAre(calib::Sample{{10.5, 20.25}, {510.125, 144.5}},
                                      calib::Sample{{1000.5, 20.25}, {1490.0625, 143.75}}));
  EXPECT_EQ(p1.model,
            (calib::ProjectorModel{{0.001, 0, -1, 0, 0.001, -0.5, 0, 0, 1}, {512, 384}, 1024, {0.01, 0, 0}, {0, 0}}));
  EXPECT_EQ(p1.quality, (calib::FitQuality{0.03, 0.06, 0.11, 2, 100}));
  EXPECT_EQ(p1.alpha, "calibration/p1-alpha.png");
  EXPECT_EQ(p1.response, "calibration/p1-response.csv");
  EXPECT_EQ(calibration.projectors[1].flatAt, glm::ivec2(1024, 0));
  EXPECT_EQ(calibration.find("left.2"), &calibration.projectors[1]);
  EXPECT_EQ(calibration.find("p2"), nullptr);
  EXPECT_EQ(calibration.steps, (std::map<std::string, std::string>{{"camera", "0f3a"}, {"mesh", "12:ab \"quoted\""}}));
}

TEST(StoreCalibration, WritesTheSavedFileByteForByte) {
  EXPECT_EQ(formatCalibration(exampleCalibration()), dataFile("calibration-v1.yaml"));
}

TEST(StoreCalibration, MigratesVersionZero) {
  EXPECT_EQ(parseCalibration(dataFile("calibration-v0.yaml"), "calibration.yaml"), exampleCalibration());
}

TEST(StoreCalibration, RoundTripsBentScreensResidualsAndPlaces) {
  calib::Calibration calibration = exampleCalibration();
  calibration.surface->bend = calib::Bend{3000.5, -17.25, {0.5, -0.25, 1e-5}};
  calibration.places = {*calibration.surface, {{1, 0, 2, 0, 1, 3, 0, 0, 1}, 0.125, {}}};
  auto& p1 = calibration.projectors[0];
  p1.model.bend = calib::Bend{-2500, 12, {1e-4, 2, 3}};
  p1.model.residual = calib::ResidualSpline{1, 2, std::vector<glm::dvec2>(20, {0.0625, -0.03})};
  p1.light = calib::LightMatch{{0.9, 0.01, 0, 0, 0.95, 0, 0.02, 0, 1},
                               "calibration/p1-gain.png",
                               "calibration/p1 black.png",
                               {0.125, 0.0625, 0.03125}};
  p1.measured = calib::MeasuredLight{"calibration/p1-white.png", 211.5, {1, 0.1, 0, 0, 2, 0, 0.25, 0, 3}, true, 0.002};
  p1.quality.heldOut = 0.031;
  p1.quality.deviation = 0.007;
  p1.quality.cameraScale = 0.41;
  EXPECT_EQ(parseCalibration(formatCalibration(calibration), "calibration.yaml"), calibration);
}

TEST(StoreCalibration, RoundTripsWhatTheCameraMeasuredOfResponses) {
  calib::Calibration calibration = exampleCalibration();
  calibration.camera->response = "calibration/camera-response.csv";
  calibration.projectors[0].responseError = 0.0081;
  calibration.projectors[0].leak = 0.0023;
  EXPECT_EQ(parseCalibration(formatCalibration(calibration), "calibration.yaml"), calibration);
}

TEST(StoreCalibration, RefusesASplineWithTheWrongNumberOfControlPoints) {
  calib::Calibration calibration = exampleCalibration();
  calibration.projectors[0].model.residual = calib::ResidualSpline{1, 1, std::vector<glm::dvec2>(15)};
  EXPECT_THAT(
      [&] { (void)parseCalibration(formatCalibration(calibration), "calibration.yaml"); },
      ::testing::ThrowsMessage<calib::StoreError>(::testing::HasSubstr("expected 16 control points, found 15")));
}

TEST(StoreCalibration, RoundTripsWhatHasNotBeenMeasuredYet) {
  const calib::Calibration nothing;
  EXPECT_EQ(parseCalibration(formatCalibration(nothing), "calibration.yaml"), nothing);
}

TEST(StoreCalibration, RoundTripsAnyNumberExactly) {
  std::mt19937_64 random(20240501);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  std::uniform_int_distribution<int> exponent(-300, 7);
  calib::Calibration calibration = exampleCalibration();
  auto& samples = calibration.projectors[0].samples;
  const auto next = [&] { return mantissa(random) * std::pow(10.0, exponent(random)); };
  for (int i = 0; i < 5000; ++i) samples.push_back({{next(), next()}, {next(), next()}});
  samples.push_back({{std::numeric_limits<double>::denorm_min(), -0.0}, {std::numeric_limits<double>::min(), 1e9}});
  EXPECT_EQ(parseCalibration(formatCalibration(calibration), "calibration.yaml"), calibration);
}

TEST(StoreCalibration, RefusesANewerVersion) {
  EXPECT_THAT(calibrationProblems(exampleWith("version: 1", "version: 2")),
              ElementsAre("3:10 version: written by a newer PixelFlex (version 2, this program knows up to 1)"));
}

struct BadEdit {
  std::string from;
  std::string to;
  std::string message;
};

void PrintTo(const BadEdit& edit, std::ostream* stream) {
  *stream << edit.from << " -> " << edit.to;
}

class StoreCalibrationEdit : public ::testing::TestWithParam<BadEdit> {};

TEST_P(StoreCalibrationEdit, IsRefusedWithAClearMessage) {
  const auto problems = calibrationProblems(exampleWith(GetParam().from, GetParam().to));
  ASSERT_EQ(problems.size(), 1U) << ::testing::PrintToString(problems);
  EXPECT_THAT(problems[0], HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Edits, StoreCalibrationEdit,
    ::testing::Values(
        BadEdit{"fx: 1500.25", "fx: 0", "fx: expected a number"}, BadEdit{"fx: 1500.25\n  ", "", "\"fx\" is missing"},
        BadEdit{"radial: [-0.1, 0.02, 0]", "radial: [-0.1, 0.02]", "expected a list of 3, found 2"},
        BadEdit{"[1.6, 0.01, -20, 0.02, 1.7, -30, 1e-06, 2e-06, 1]", "[1, 2, 3, 2, 4, 6, 0, 0, 1]", "singular"},
        BadEdit{"rect: [100, 50, 2900, 1450]", "rect: [2900, 50, 100, 1450]", "left < right"},
        BadEdit{"resolution: [2000, 1000]", "resolution: [32768, 32768]", "more than 2^29 pixels"},
        BadEdit{"resolution: [2000, 1000]", "resolution: [2000, 0]", "from 1 to 32768"},
        BadEdit{"name: left.2", "name: p1", "two projectors have the name"},
        BadEdit{"found: 2,", "found: 101,", "more found than shown"},
        BadEdit{"scale: 1024", "scale: 0", "scale: expected a number"},
        BadEdit{"- [10.5, 20.25, 510.125, 144.5]", "- [10.5, 20.25, 510.125, 1e10]", "samples: expected a number"},
        BadEdit{"- [10.5, 20.25, 510.125, 144.5]", "- [10.5, 20.25]", "samples: expected a list of 4, found 2"},
        BadEdit{"- [10.5, 20.25, 510.125, 144.5]", "- {x: 1}", "samples: expected a list of 4"},
        BadEdit{"    samples: []\n", "", "\"samples\" is missing"},
        BadEdit{"camera: 0f3a", "camera: [1]", "camera: expected a text"},
        BadEdit{"alpha: calibration/p1-alpha.png", "alfa: calibration/p1-alpha.png", "did you mean \"alpha\"?"}));

TEST(StoreCalibration, SaysWhatToDoWithoutAModel) {
  EXPECT_THAT(calibrationProblems("format: pixelflex-calibration\nversion: 1\nprojectors:\n"
                                  "  - {name: p1, resolution: [1024, 768], samples: [[1, 2, 3, 4]]}\n"),
              ElementsAre("4:5 projectors: no model: run pixelflex calibrate WALL mesh"));
}

TEST(StoreCalibration, OfAFlatWallIsExact) {
  calib::Wall wall = flatWall(2, 2);
  wall.projectors[3].resolution = {1920, 1080};
  const calib::Calibration calibration = calib::flatCalibration(wall);
  EXPECT_EQ(calibration.display, (calib::Display{0, 0, 2944, 1848, {2944, 1848}}));
  ASSERT_EQ(calibration.projectors.size(), 4U);
  for (const auto& projector : calibration.projectors) {
    ASSERT_EQ(projector.samples.size(), 4U);
    for (const auto& sample : projector.samples) {
      const auto& m = projector.model.projectorFromWall;
      const glm::dvec2 w = sample.pointInWall;
      EXPECT_EQ(glm::dvec2(m[0] * w.x + m[1] * w.y + m[2], m[3] * w.x + m[4] * w.y + m[5]), sample.pointInProjector);
      EXPECT_EQ(sample.pointInWall - sample.pointInProjector, glm::dvec2(*projector.flatAt));
    }
    EXPECT_EQ(projector.quality, (calib::FitQuality{0, 0, 0, 4, 4}));
  }
  EXPECT_EQ(parseCalibration(formatCalibration(calibration), "calibration.yaml"), calibration);
}

}  // namespace
}  // namespace pixelflex::testing
