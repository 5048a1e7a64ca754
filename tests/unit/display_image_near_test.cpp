// The comparison that other tests rely on: it must be able to fail, and leave pictures when it does.
#include <gtest/gtest.h>

#include "tests/support_image/image_near.h"

namespace pixelflex::testing {
namespace {

devices::Image8 grey(int code) {
  devices::Image8 image({7, 5}, 3);
  for (auto& sample : image.samples()) sample = static_cast<std::uint8_t>(code);
  return image;
}

TEST(ImageNearTest, AcceptsWithinTheTolerance) {
  EXPECT_TRUE(imageNear(grey(10), grey(10), 0, "image-near-same"));
  EXPECT_TRUE(imageNear(grey(10), grey(12), 2, "image-near-within"));
  EXPECT_FALSE(std::filesystem::exists(failureFolder("image-near-within")));
}

TEST(ImageNearTest, RefusesOneSampleTooFarAndLeavesPictures) {
  const std::string name = "image-near-must-fail";
  auto actual = grey(10);
  actual.at(4, 3, 2) = 13;
  const auto result = imageNear(actual, grey(10), 2, name);
  ASSERT_FALSE(result);
  EXPECT_NE(std::string(result.message()).find("1 samples differ by more than 2, the worst by 3 at (4, 3)"),
            std::string::npos)
      << result.message();
  EXPECT_EQ(devices::readPng8(failureFolder(name) / "actual.png"), actual);
  EXPECT_EQ(devices::readPng8(failureFolder(name) / "expected.png"), grey(10));
  const auto difference = devices::readPng8(failureFolder(name) / "diff.png");
  EXPECT_EQ(difference.at(4, 3, 2), 115);
  EXPECT_EQ(difference.at(0, 0, 0), 0);
  std::filesystem::remove_all(failureFolder(name));
}

TEST(ImageNearTest, RefusesAnotherSize) {
  EXPECT_FALSE(imageNear(grey(1), devices::Image8({5, 7}, 3), 255, "image-near-size"));
  std::filesystem::remove_all(failureFolder("image-near-size"));
}

}  // namespace
}  // namespace pixelflex::testing
