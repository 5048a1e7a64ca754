// Still cameras, with a stand-in for libgphoto2: there is none where tests run.

#include "devices/camera/still_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "devices/camera/camera_error.h"
#include "devices/camera/cameras.h"
#include "tests/support_image/jpeg.h"

namespace pixelflex::testing {
namespace {

using devices::CameraError;
using devices::Size;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A JPEG of one grey.
std::vector<std::uint8_t> greyJpeg(Size size, int code) {
  devices::Image8 image(size, 1);
  std::ranges::fill(image.samples(), static_cast<std::uint8_t>(code));
  return testing::jpegOf(image);
}

/// Settings as a Canon has them.
class FakeStill final : public devices::StillDevice {
 public:
  std::map<std::string, std::string> values = {
      {"autoexposuremode", "AV"},       {"focusmode", "One Shot"}, {"imageformat", "RAW"},
      {"capturetarget", "Memory card"}, {"iso", "Auto"},           {"whitebalance", "Auto"},
      {"shutterspeed", "1/125"}};
  std::map<std::string, std::vector<std::string>> menus = {
      {"autoexposuremode", {"P", "TV", "AV", "Manual"}},
      {"focusmode", {"One Shot", "AI Servo", "Manual"}},
      {"imageformat", {"RAW", "Small Fine JPEG", "Large Fine JPEG"}},
      {"capturetarget", {"Internal RAM", "Memory card"}},
      {"iso", {"Auto", "100", "200"}},
      {"whitebalance", {"Auto", "Daylight", "Shadow"}},
      {"shutterspeed", {"bulb", "2", "0.5", "1/8", "1/60", "1/125", "1/4000"}}};
  std::set<std::string> stuck;
  Size size{40, 30};
  bool isAsleep = false;

  [[nodiscard]] std::optional<std::string> value(const std::string& setting) override {
    const auto found = values.find(setting);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::vector<std::string> choices(const std::string& setting) override { return menus[setting]; }
  void set(const std::string& setting, const std::string& value) override {
    if (!stuck.contains(setting)) values[setting] = value;
  }
  [[nodiscard]] std::vector<std::uint8_t> capture() override {
    if (isAsleep) throw std::runtime_error("the camera does not answer");
    return greyJpeg(size, 90);
  }
};

class StillCameraTest : public ::testing::Test {
 protected:
  [[nodiscard]] auto open() { return devices::makeStillCamera("gphoto2:first", std::move(own_)); }
  std::unique_ptr<FakeStill> own_ = std::make_unique<FakeStill>();
  FakeStill& still_ = *own_;  // as long as the camera lives
};

TEST_F(StillCameraTest, EverythingIsSetByHand) {
  const auto camera = open();
  EXPECT_EQ(still_.values["autoexposuremode"], "Manual");
  EXPECT_EQ(still_.values["focusmode"], "Manual");
  EXPECT_EQ(still_.values["imageformat"], "Large Fine JPEG");
  EXPECT_EQ(still_.values["capturetarget"], "Internal RAM");
  EXPECT_EQ(still_.values["iso"], "100");
  EXPECT_EQ(still_.values["whitebalance"], "Daylight");
}

TEST_F(StillCameraTest, WhatWasChosenByHandStays) {
  still_.values["iso"] = "200";
  still_.values["whitebalance"] = "Shadow";
  const auto camera = open();
  EXPECT_EQ(still_.values["iso"], "200");
  EXPECT_EQ(still_.values["whitebalance"], "Shadow");
}

TEST_F(StillCameraTest, WhatItDoesNotTakeIsNamed) {
  still_.stuck = {"focusmode"};
  try {
    (void)open();
    FAIL() << "a camera that focuses by itself";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("gphoto2:first: its focus mode stays One Shot"), HasSubstr("lens")));
  }
}

TEST_F(StillCameraTest, TheNearestTimeOfTheMenuIsChosen) {
  const auto camera = open();
  auto* control = camera->exposureControl();
  ASSERT_NE(control, nullptr);
  EXPECT_DOUBLE_EQ(control->exposure(), 1.0 / 125);
  EXPECT_DOUBLE_EQ(control->exposureRange().shortest, 1.0 / 4000);
  EXPECT_DOUBLE_EQ(control->exposureRange().longest, 2);
  EXPECT_DOUBLE_EQ(control->setExposure(0.3), 0.5);
  EXPECT_EQ(still_.values["shutterspeed"], "0.5");
  EXPECT_DOUBLE_EQ(control->setExposure(0.02), 1.0 / 60);
  still_.stuck = {"shutterspeed"};
  EXPECT_THROW(control->setExposure(2), CameraError);
}

TEST_F(StillCameraTest, PhotographsAreThoseOfTheCamera) {
  const auto camera = open();
  EXPECT_EQ(camera->size(), (Size{40, 30}));
  EXPECT_NEAR(camera->shoot().at(20, 15, 2), 90, 1);
  still_.size = {20, 10};
  EXPECT_THROW((void)camera->shoot(), CameraError);
  still_.isAsleep = true;
  try {
    (void)camera->shoot();
    FAIL() << "a photograph from nowhere";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gphoto2:first: it takes no photograph: the camera does not answer"));
  }
}

TEST(StillCameras, TimesOfMenus) {
  EXPECT_DOUBLE_EQ(devices::shutterSeconds("1/60").value_or(0), 1.0 / 60);
  EXPECT_DOUBLE_EQ(devices::shutterSeconds("0.0166s").value_or(0), 0.0166);
  EXPECT_DOUBLE_EQ(devices::shutterSeconds("1.3\"").value_or(0), 1.3);
  EXPECT_DOUBLE_EQ(devices::shutterSeconds("30").value_or(0), 30);
  for (const auto* other : {"bulb", "", "Auto", "1/", "/8", "0", "-1"}) {
    EXPECT_FALSE(devices::shutterSeconds(other)) << other;
  }
}

TEST(StillCameras, OnesThatAreNotThereAreNamed) {
  try {
    (void)devices::openCamera("gphoto2:No Such Model");
    FAIL() << "opened";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gphoto2:No Such Model: there is no such camera on USB"));
  }
}

}  // namespace
}  // namespace pixelflex::testing
