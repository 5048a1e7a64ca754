// Exposures measured with the camera itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "calib/capture/exposure_meter.h"
#include "calib/capture/photographs.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::Scene;

/// A projector that is so bright when it shows white.
class Lamp final : public devices::Projector {
 public:
  explicit Lamp(double brightness) : brightness_(brightness) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] devices::Size resolution() const override { return {8, 6}; }
  void show(const Image8& frame) override { light = brightness_ * frame.at(3, 3) / 255.0; }
  void blank() override { light = 0; }
  double light = 0;

 private:
  std::string name_ = "lamp";
  double brightness_;
};

/// Sees the lamps, one part of the picture each, and the room.
class Eye final : public devices::Camera, public devices::ExposureControl {
 public:
  Eye(std::vector<Lamp*> lamps, double gamma) : lamps_(std::move(lamps)), gamma_(gamma) {}
  [[nodiscard]] devices::Size size() const override { return {100, 50}; }
  [[nodiscard]] Image8 shoot() override {
    ++photographs;
    Image8 photo(size(), 3);
    for (int y = 0; y < 50; ++y) {
      for (int x = 0; x < 100; ++x) {
        const double lamp = lamps_[static_cast<std::size_t>(x) * lamps_.size() / 100]->light;
        const double seen = std::pow(std::clamp((lamp + room) * seconds, 0.0, 1.0), 1 / gamma_);
        for (int c = 0; c < 3; ++c) photo.at(x, y, c) = static_cast<std::uint8_t>(std::lround(255 * seen));
      }
    }
    return photo;
  }
  [[nodiscard]] ExposureControl* exposureControl() override { return this; }
  [[nodiscard]] devices::ExposureRange exposureRange() const override { return range; }
  [[nodiscard]] double exposure() override { return seconds; }
  double setExposure(double wanted) override {
    seconds = std::clamp(wanted, range.shortest, range.longest);
    if (step > 0) seconds = std::exp2(step * std::round(std::log2(seconds) / step));
    return seconds;
  }
  double step = 0;  // between exposures, in stops
  devices::ExposureRange range{.shortest = 1e-4, .longest = 10};
  double seconds = 0.01;
  double room = 0.001;
  int photographs = 0;

 private:
  std::vector<Lamp*> lamps_;
  double gamma_;
};

class Helper final : public devices::Operator {
 public:
  explicit Helper(Eye& eye) : eye_(eye) {}
  [[nodiscard]] bool arrange(Scene scene, int index) override {
    eye_.room = scene == Scene::kDark ? 0.001 : 3;
    return index < 3;
  }

 private:
  Eye& eye_;
};

TEST(ExposureMeter, TheBrightestProjectorsWhiteDecides) {
  for (const double gamma : {1.0, 2.2}) {
    for (const double start : {2e-4, 0.01, 5.0}) {
      Lamp dim(2);
      Lamp bright(9);
      Eye eye({&dim, &bright}, gamma);
      Helper helper(eye);
      eye.seconds = start;
      MeteredPerson person(helper, eye, {&dim, &bright}, "camera");
      ASSERT_TRUE(person.arrange(Scene::kDark, 0));
      EXPECT_EQ(dim.light + bright.light, 0);
      Image8 white({8, 6}, 1);
      std::ranges::fill(white.samples(), std::uint8_t{255});
      bright.show(white);
      const int peak = peakOf(eye.shoot());
      EXPECT_GE(peak, 185) << gamma << ' ' << start;
      EXPECT_LE(peak, 235) << gamma << ' ' << start;
    }
  }
}

TEST(ExposureMeter, EachSceneIsMeasuredOnceAndKept) {
  Lamp lamp(5);
  Eye eye({&lamp}, 1);
  Helper helper(eye);
  MeteredPerson person(helper, eye, {&lamp}, "camera");
  ASSERT_TRUE(person.arrange(Scene::kDark, 0));
  const double dark = eye.seconds;
  ASSERT_TRUE(person.arrange(Scene::kRoomLight, 0));
  const double lit = eye.seconds;
  const int photographs = eye.photographs;
  eye.seconds = 1;
  ASSERT_TRUE(person.arrange(Scene::kDark, 0));
  EXPECT_EQ(eye.seconds, dark);
  ASSERT_TRUE(person.arrange(Scene::kCheckerboard, 1));
  EXPECT_EQ(eye.seconds, lit);
  EXPECT_EQ(eye.photographs, photographs);
  EXPECT_FALSE(person.arrange(Scene::kCheckerboard, 3));
}

TEST(ExposureMeter, ExposuresThatComeInStepsAreMeasuredToo) {
  Image8 white({8, 6}, 1);
  std::ranges::fill(white.samples(), std::uint8_t{255});
  for (const double step : {1.0 / 3, 0.5, 1.0}) {
    for (double brightness = 4; brightness < 9; brightness *= 1.02) {
      Lamp lamp(brightness);
      Eye eye({&lamp}, 1);
      eye.step = step;
      Helper helper(eye);
      MeteredPerson person(helper, eye, {&lamp}, "camera");
      ASSERT_TRUE(person.arrange(Scene::kDark, 0)) << step << ' ' << brightness;
      lamp.show(white);
      const int peak = peakOf(eye.shoot());
      EXPECT_LE(peak, 233) << step << ' ' << brightness;
      EXPECT_GE(peak, 233 / std::exp2(step) - 5) << step << ' ' << brightness;
    }
  }
}

TEST(ExposureMeter, RangesThatEndBetweenStepsEndMetering) {
  Lamp lamp(1e6);
  Eye eye({&lamp}, 1);
  eye.step = 1.0 / 3;
  Helper helper(eye);
  MeteredPerson person(helper, eye, {&lamp}, "camera");
  try {
    (void)person.arrange(Scene::kDark, 0);
    FAIL() << "over-exposed, and nobody said so";
  } catch (const CaptureError& error) {
    EXPECT_NE(std::string(error.what()).find("camera: over-exposed"), std::string::npos) << error.what();
  }
  Lamp faint(0.01);
  Eye other({&faint}, 1);
  other.step = 1.0 / 3;
  Helper another(other);
  MeteredPerson patient(another, other, {&faint}, "camera");
  EXPECT_TRUE(patient.arrange(Scene::kDark, 0));
  EXPECT_NEAR(other.seconds, other.range.longest, 2);
}

TEST(ExposureMeter, TooMuchLightIsAnErrorAndTooLittleThePhotographsMatter) {
  Lamp lamp(1e6);
  Eye eye({&lamp}, 1);
  Helper helper(eye);
  MeteredPerson person(helper, eye, {&lamp}, "aravis:x");
  try {
    (void)person.arrange(Scene::kDark, 0);
    FAIL() << "over-exposed, and nobody said so";
  } catch (const CaptureError& error) {
    EXPECT_NE(std::string(error.what()).find("aravis:x: over-exposed"), std::string::npos);
  }
  Lamp faint(0.01);
  Eye other({&faint}, 1);
  Helper another(other);
  MeteredPerson patient(another, other, {&faint}, "camera");
  EXPECT_TRUE(patient.arrange(Scene::kDark, 0));
  EXPECT_EQ(other.seconds, other.range.longest);
}

}  // namespace
}  // namespace pixelflex::calib
