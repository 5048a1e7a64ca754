// What the store knows of a projector's light, as the renderer gets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "calib/store/calibration.h"
#include "devices/image/image_error.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "viewer/plan/projector_light.h"

namespace pixelflex::viewer {
namespace {

using devices::Image16;
using devices::Image8;
using devices::Size;

class PlanLightTest : public ::testing::Test {
 protected:
  PlanLightTest() {
    projector_.name = "p1";
    projector_.resolution = {40, 30};
    projector_.alpha = "alpha.png";
    projector_.light =
        calib::LightMatch{.colour = {1, 2, 3, 4, 5, 6, 7, 8, 9}, .gain = "gain.png", .black = "black.png"};
    write("alpha.png", {40, 30}, 1);
    write("gain.png", {9, 7}, 2);
    write("black.png", {40, 30}, 3);
  }

  void write(const std::string& name, Size size, std::uint16_t value, int channels = 1) {
    Image16 image(size, channels);
    std::ranges::fill(image.samples(), value);
    devices::writePng(folder() / name, image);
  }
  [[nodiscard]] ProjectorLight read() const { return readLight(folder(), projector_); }
  [[nodiscard]] std::string problem() const {
    try {
      (void)read();
    } catch (const PlanError& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }

  testing::TemporaryFolder folder_;
  calib::ProjectorCalibration projector_;
};

TEST_F(PlanLightTest, ReadsMatrixAndMaps) {
  const auto light = read();
  EXPECT_EQ(light.colour * glm::vec3(1, 0, 0), glm::vec3(1, 4, 7));
  EXPECT_EQ(light.colour * glm::vec3(0, 0, 1), glm::vec3(3, 6, 9));
  EXPECT_EQ(light.alpha.at(39, 29), 1);
  EXPECT_EQ(light.gain.size(), (Size{9, 7}));
  EXPECT_EQ(light.gain.at(8, 6), 2);
  EXPECT_EQ(light.black.at(0, 0), 3);
  EXPECT_TRUE(light.inverseResponse[0].empty());
}

TEST_F(PlanLightTest, WhatIsNotThereIsAbsent) {
  projector_.light.reset();
  projector_.alpha.reset();
  const auto light = read();
  EXPECT_EQ(light.colour, glm::mat3(1));
  EXPECT_TRUE(light.alpha.empty() && light.gain.empty() && light.black.empty());
}

TEST_F(PlanLightTest, AnExactScreenIsShownAsItIs) {
  projector_.flatAt = glm::ivec2(0, 0);
  const auto light = read();
  EXPECT_EQ(light.colour, glm::mat3(1));
  EXPECT_TRUE(light.alpha.empty() && light.gain.empty() && light.black.empty());
}

TEST_F(PlanLightTest, AMissingFileIsNamedWithTheCure) {
  for (const auto* name : {"alpha.png", "gain.png", "black.png"}) {
    std::filesystem::remove(folder() / name);
    EXPECT_THAT(problem(), ::testing::AllOf(::testing::HasSubstr(name), ::testing::HasSubstr("needs this file"),
                                            ::testing::HasSubstr("pixelflex calibrate")));
    write(name, {40, 30}, 0);
  }
}

TEST_F(PlanLightTest, APictureOfAnotherSizeOrInColourIsRefused) {
  write("black.png", {40, 29}, 0);
  EXPECT_THAT(problem(), ::testing::HasSubstr("resolution"));
  write("black.png", {40, 30}, 0);
  write("gain.png", {9, 7}, 0, 3);
  EXPECT_THAT(problem(), ::testing::AllOf(::testing::HasSubstr("gain.png"), ::testing::HasSubstr("grey")));
}

}  // namespace
}  // namespace pixelflex::viewer
