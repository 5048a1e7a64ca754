// V4L2 cameras, with a stand-in for the kernel: there is no camera where tests run.

#include "devices/camera/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "devices/camera/camera_error.h"
#include "devices/camera/cameras.h"
#include "tests/support_devices/fake_video.h"

namespace pixelflex::testing {
namespace {

using devices::Camera;
using devices::CameraError;
using devices::Size;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

class V4l2CameraTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<Camera> open() { return devices::makeV4l2Camera("v4l2:/dev/video9", std::move(own_)); }
  [[nodiscard]] std::string errorOfOpening() {
    try {
      (void)open();
    } catch (const CameraError& error) {
      return error.what();
    }
    return "";
  }
  std::unique_ptr<FakeVideo> own_ = std::make_unique<FakeVideo>();
  FakeVideo& video_ = *own_;  // as long as the camera lives
};

std::chrono::microseconds realTime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch());
}

std::string errorOf(Camera& camera) {
  try {
    (void)camera.shoot();
  } catch (const CameraError& error) {
    return error.what();
  }
  return "";
}

TEST_F(V4l2CameraTest, TheLargestPictureIsTakenAndUncompressedAmongEquals) {
  video_.formats = {{V4L2_PIX_FMT_MJPEG, {{640, 480}, {32, 24}}}, {V4L2_PIX_FMT_YUYV, {{320, 240}, {640, 480}}}};
  const auto camera = open();
  EXPECT_EQ(camera->size(), (Size{640, 480}));
  EXPECT_EQ(video_.pixelFormat(), V4L2_PIX_FMT_YUYV);
}

TEST_F(V4l2CameraTest, EverythingAutomaticIsSwitchedOff) {
  const auto camera = open();
  EXPECT_EQ(video_.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(video_.controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
  EXPECT_EQ(video_.controls[V4L2_CID_FOCUS_AUTO].value, 0);
}

TEST_F(V4l2CameraTest, WhatStaysAutomaticIsNamed) {
  video_.controls[V4L2_CID_FOCUS_AUTO].stuck = true;
  video_.controls[V4L2_CID_AUTO_WHITE_BALANCE].stuck = true;
  EXPECT_THAT(errorOfOpening(), AllOf(HasSubstr("v4l2:/dev/video9: "), HasSubstr("automatic white balance"),
                                      HasSubstr("automatic focus stays on")));
}

TEST_F(V4l2CameraTest, ExposureIsSetInItsUnitsAndReadBack) {
  const auto camera = open();
  auto* control = camera->exposureControl();
  ASSERT_NE(control, nullptr);
  EXPECT_NEAR(control->exposure(), 0.025, 1e-9);
  EXPECT_NEAR(control->setExposure(0.0123), 0.0123, 1e-9);
  EXPECT_EQ(video_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 123);
  EXPECT_NEAR(control->setExposure(60), 0.2047, 1e-9);
  video_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].refusals = 1;  // some want to be automatic once more before
  EXPECT_NEAR(control->setExposure(0.02), 0.02, 1e-9);
  EXPECT_EQ(video_.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
  video_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].stuck = true;
  EXPECT_THROW(control->setExposure(0.1), CameraError);
}

TEST_F(V4l2CameraTest, FramesFromBeforeAreDropped) {
  const auto camera = open();
  for (int i = 0; i < 3; ++i) {
    video_.now = realTime() - milliseconds(2000);
    video_.pass(milliseconds(1000));  // the queue fills while nobody looks
    const int before = video_.frames;
    video_.now = realTime();
    const auto photo = camera->shoot();
    EXPECT_GT(photo.at(0, 0), before + 1);
  }
}

TEST_F(V4l2CameraTest, WithoutUsableTimeStampsTheWholeQueueIsDropped) {
  video_.stamps = V4L2_BUF_FLAG_TIMESTAMP_COPY;
  const auto camera = open();
  video_.pass(milliseconds(1000));
  const int before = video_.frames;
  EXPECT_GT(camera->shoot().at(0, 0), before + 1);
}

TEST_F(V4l2CameraTest, TimeStampsOfThePastAreNamed) {
  const auto camera = open();
  video_.now = realTime() - std::chrono::hours(1);
  EXPECT_THAT(errorOf(*camera), AllOf(HasSubstr("v4l2:/dev/video9: "), HasSubstr("stamped with times before")));
}

TEST_F(V4l2CameraTest, DamagedFramesAreLeftOut) {
  const auto camera = open();
  video_.damaged = 8;
  EXPECT_EQ(camera->shoot().size(), camera->size());
  video_.damaged = 1000;
  EXPECT_THAT(errorOf(*camera), HasSubstr("its frames are damaged"));
}

TEST_F(V4l2CameraTest, JpegThatIsNoneIsDamagedToo) {
  video_.formats = {{V4L2_PIX_FMT_MJPEG, {{640, 480}}}};
  video_.jpeg = {0xff, 0xd8, 0xff, 0xe0, 0, 0};
  const auto camera = open();
  EXPECT_THAT(errorOf(*camera), HasSubstr("damaged JPEG"));
}

TEST_F(V4l2CameraTest, CamerasThatFallSilentOrAreUnpluggedAreNamed) {
  const auto camera = open();
  video_.silent = true;
  EXPECT_THAT(errorOf(*camera), AllOf(HasSubstr("v4l2:/dev/video9: no frame comes"), HasSubstr("plug it in again")));
  video_.silent = false;
  video_.gone = ENODEV;
  EXPECT_THAT(errorOf(*camera), HasSubstr("the camera is gone"));
}

TEST_F(V4l2CameraTest, DevicesInUseAreNamed) {
  video_.busy = EBUSY;
  EXPECT_THAT(errorOfOpening(), HasSubstr("another program uses this camera"));
}

TEST_F(V4l2CameraTest, DevicesThatGiveNoPicturesAreNamed) {
  video_.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(errorOfOpening(), HasSubstr("gives no pictures"));
}

TEST_F(V4l2CameraTest, FormatsThatCannotBeReadAreNamed) {
  video_.formats = {{V4L2_PIX_FMT_H264, {{640, 480}}}};
  EXPECT_THAT(errorOfOpening(), HasSubstr("none of its pixel formats"));
}

TEST(V4l2Kernel, DevicesThatAreNotThereOrNoCamerasAreNamed) {
  try {
    (void)devices::openCamera("v4l2:/dev/no-such-video");
    FAIL() << "opened";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("v4l2:/dev/no-such-video: there is no such device"), HasSubstr("list")));
  }
  try {
    (void)devices::openCamera("v4l2:/dev/null");
    FAIL() << "opened";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), HasSubstr("v4l2:/dev/null: this device gives no pictures"));
  }
}

}  // namespace
}  // namespace pixelflex::testing
