// Photographs taken live: which projector shines, where the camera stands, what is kept.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib/capture/folder_photographs.h"
#include "calib/capture/live_photographs.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using devices::Image8;
using devices::Scene;
using pixelflex::testing::TemporaryFolder;

class OneProjector final : public devices::Projector {
 public:
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] devices::Size resolution() const override { return {4, 3}; }
  void show(const Image8& frame) override { shown = frame.at(0, 0); }
  void blank() override { shown = 0; }
  int shown = 255;

 private:
  std::string name_ = "p1";
};

class Person final : public devices::Operator {
 public:
  [[nodiscard]] bool arrange(Scene, int index) override { return index < 2; }
  [[nodiscard]] bool placeCamera(int wanted) override {
    if (wanted >= places) return false;
    place = wanted;
    return true;
  }
  int places = 1;
  int place = 0;
};

/// Sees what the projector shows, and from where; twice as bright when exposed twice as long.
class Eye final : public devices::Camera, public devices::ExposureControl {
 public:
  Eye(const OneProjector& projector, const Person& person) : projector_(projector), person_(person) {}
  [[nodiscard]] devices::Size size() const override { return {4, 3}; }
  [[nodiscard]] Image8 shoot() override {
    Image8 photo(size(), 3);
    const double seen = projector_.shown * seconds_ / kUsual;
    for (auto& code : photo.samples()) code = static_cast<std::uint8_t>(std::lround(seen) + person_.place);
    return photo;
  }
  [[nodiscard]] devices::ExposureControl* exposureControl() override { return canExpose ? this : nullptr; }
  [[nodiscard]] devices::ExposureRange exposureRange() const override { return {.shortest = 0.001, .longest = 1}; }
  [[nodiscard]] double exposure() override { return seconds_; }
  double setExposure(double seconds) override { return seconds_ = std::clamp(seconds, 0.001, 1.0); }
  static constexpr double kUsual = 0.02;
  bool canExpose = true;

 private:
  const OneProjector& projector_;
  const Person& person_;
  double seconds_ = kUsual;
};

ProjectedPattern grey(int code) {
  return {"grey", "", [code] {
            Image8 image({4, 3}, 1);
            for (auto& sample : image.samples()) sample = static_cast<std::uint8_t>(code);
            return image;
          }};
}

class LiveTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path captures() const { return folder_ / "captures"; }
  [[nodiscard]] fs::path gathering() const { return folder_ / "captures.new"; }
  LivePhotographs& start(int placeCount) {
    person_.places = placeCount;
    live_.emplace(camera_, std::vector<devices::Projector*>{&projector_}, person_, captures(), "identity", 2,
                  placeCount);
    return *live_;
  }
  static int codeOf(const Image8& photo) { return photo.at(0, 0); }

  TemporaryFolder folder_;
  OneProjector projector_;
  Person person_;
  Eye camera_{projector_, person_};
  std::optional<LivePhotographs> live_;
};

TEST_F(LiveTest, NothingIsReplacedBeforeKeep) {
  auto& first = start(1);
  EXPECT_EQ(codeOf(first.pattern("p1", grey(40))), 40);
  first.keep(Kept::kAll);
  EXPECT_EQ(codeOf(devices::readPng8(captures() / "p1/grey.png")), 40);
  auto& second = start(1);
  EXPECT_EQ(codeOf(second.pattern("p1", grey(80))), 80);
  live_.reset();  // as when something goes wrong
  EXPECT_EQ(codeOf(devices::readPng8(captures() / "p1/grey.png")), 40);
  EXPECT_EQ(projector_.shown, 0);
}

TEST_F(LiveTest, AFailedAttemptDoesNotMixWithTheNext) {
  EXPECT_EQ(codeOf(start(1).pattern("p1", {"stripes", "", grey(9).render})), 9);
  auto& next = start(1);
  EXPECT_EQ(codeOf(next.pattern("p1", grey(80))), 80);
  next.keep(Kept::kAll);
  EXPECT_TRUE(fs::exists(captures() / "p1/grey.png"));
  EXPECT_FALSE(fs::exists(captures() / "p1/stripes.png"));
  EXPECT_FALSE(fs::exists(gathering()));
}

TEST_F(LiveTest, EveryPlaceHasItsPhotographs) {
  auto& live = start(3);
  EXPECT_EQ(live.placeCount(), 3);
  EXPECT_EQ(live.nextCheckerboard()->name, (gathering() / "checkerboard/1.png").string());
  for (int place = 0; place < 3; ++place) {
    live.choosePlace(place);
    EXPECT_EQ(projector_.shown, 0) << "while the camera is carried";
    EXPECT_EQ(codeOf(live.fiducials().photo), place);
    EXPECT_EQ(codeOf(live.pattern("p1", grey(40))), 40 + place);
  }
  live.keep(Kept::kAll);
  FolderPhotographs kept({captures()}, captures());
  ASSERT_EQ(kept.placeCount(), 3);
  EXPECT_EQ(kept.checkerboardCount(), 1);
  kept.choosePlace(2);
  EXPECT_EQ(codeOf(kept.pattern("p1", grey(0))), 42);
  EXPECT_EQ(codeOf(kept.fiducials().photo), 2);
}

TEST_F(LiveTest, ExposesAsAskedAndComesBackToTheUsual) {
  auto& live = start(1);
  ASSERT_TRUE(live.exposureRange());
  EXPECT_EQ(live.exposureRange()->longest, 1);
  EXPECT_EQ(live.usualExposure(), Eye::kUsual);
  const auto shot = live.exposed("p1", grey(40), 0.06, {1, 1, 3, 2});
  EXPECT_EQ(codeOf(shot.photo), 120);
  EXPECT_EQ(shot.seconds, 0.06);
  EXPECT_EQ(live.usualExposure(), Eye::kUsual);
  EXPECT_EQ(live.exposed("p1", grey(0), 7, {0, 0, 4, 3}).seconds, 1) << "what the camera can";
  EXPECT_EQ(codeOf(live.pattern("p1", {"other", "", grey(40).render})), 40);
  live.keep(Kept::kAll);
  const auto kept = devices::readPng8(captures() / "p1/grey@0.06.png");
  EXPECT_EQ(kept.at(0, 0), 0) << "outside of the region";
  EXPECT_EQ(kept.at(1, 1), 120);
  EXPECT_EQ(kept.at(3, 1), 0);
  FolderPhotographs again({captures()}, captures());
  EXPECT_EQ(again.exposures("p1", "grey").size(), 2U);
}

TEST_F(LiveTest, TheExposureIsTheUsualOneWhateverEndsTheWork) {
  (void)start(1).exposed("p1", grey(40), 0.5, {0, 0, 4, 3});
  EXPECT_EQ(camera_.exposure(), 0.5);
  live_.reset();
  EXPECT_EQ(camera_.exposure(), Eye::kUsual);
}

TEST_F(LiveTest, ACameraMayNotBeToldItsExposure) {
  camera_.canExpose = false;
  EXPECT_FALSE(start(1).exposureRange());
}

TEST_F(LiveTest, SaysWhenTheCameraCannotBeMoved) {
  auto& live = start(2);
  person_.places = 1;
  EXPECT_THROW(live.choosePlace(1), CaptureError);
  const std::string ofTwo = live.stamp("patterns");
  EXPECT_NE(ofTwo, start(1).stamp("patterns"));
}

}  // namespace
}  // namespace pixelflex::calib
