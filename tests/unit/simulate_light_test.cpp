#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "calib/simulate/blur.h"
#include "calib/simulate/light_image.h"
#include "calib/simulate/planar_screen.h"
#include "calib/simulate/projector_light.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;

Image8 plain(devices::Size size, std::uint8_t code) {
  Image8 image(size, 1);
  std::ranges::fill(image.samples(), code);
  return image;
}

/// Lumens on the wall: the illuminance summed over small squares of the wall, those within the frame only.
double fluxOnWall(const SimulatedProjectorSpec& spec) {
  constexpr double kStep = 4;  // mm
  const PlanarScreen screen;
  const ProjectorLight light(spec, screen);
  double flux = 0;
  for (double y = -3000; y < 3000; y += kStep) {
    for (double x = -3000; x < 3000; x += kStep) {
      const auto pixel = light.pixelFromWall({x, y});
      if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x >= spec.resolution.width ||
          pixel->y >= spec.resolution.height) {
        continue;
      }
      flux += light.illuminance({x, y}) * kStep * kStep;
    }
  }
  return flux;
}

SimulatedProjectorSpec obliqueProjector(double distance) {
  SimulatedProjectorSpec spec;
  spec.name = "p1";
  spec.resolution = {320, 240};
  spec.pose = {{0, 0, -distance}, {12, -9, 3}};
  spec.optics.focal = 500;
  spec.optics.principal = {165, 170};
  spec.optics.radial = {-0.05, 0.02, 0};
  spec.lumens = 1234;
  return spec;
}

TEST(SimulateLight, AllLumensReachTheWallFromAnyDistance) {
  EXPECT_NEAR(fluxOnWall(obliqueProjector(1500)), 1234, 1234 * 0.005);
  EXPECT_NEAR(fluxOnWall(obliqueProjector(2500)), 1234, 1234 * 0.005);
}

TEST(SimulateLight, FallsWithTheSquareOfTheDistance) {
  const PlanarScreen screen;
  const auto near = obliqueProjector(1500);
  const auto far = obliqueProjector(3000);
  const ProjectorLight nearLight(near, screen);
  const ProjectorLight farLight(far, screen);
  const glm::dvec2 pixel(100, 60);
  const double ratio = nearLight.illuminance(nearLight.wallFromPixel(pixel).value()) /
                       farLight.illuminance(farLight.wallFromPixel(pixel).value());
  EXPECT_NEAR(ratio, 4, 1e-6);
}

TEST(SimulateLight, CornersAreDarkerByTheVignetting) {
  auto spec = obliqueProjector(2000);
  spec.pose.rotation = {0, 0, 0};
  spec.optics.radial = {};
  spec.vignetting = 0.3;
  const PlanarScreen screen;
  const ProjectorLight light(spec, screen);
  const double centre = light.illuminance(light.wallFromPixel({160, 120}).value());
  EXPECT_NEAR(light.illuminance(light.wallFromPixel({0, 0}).value()) / centre, 0.7, 1e-6);
  EXPECT_NEAR(light.illuminance(light.wallFromPixel({320, 240}).value()) / centre, 0.7, 1e-6);
}

TEST(SimulateLight, ResponseRisesFromLeakToGain) {
  Response response;
  response.gamma = {1.9, 2.2, 2.5};
  response.gain = {0.9, 1.0, 1.1};
  response.toe = 0.05;
  response.black = 0.003;
  for (int channel = 0; channel < 3; ++channel) {
    const double gain = response.gain.at(static_cast<std::size_t>(channel));
    EXPECT_NEAR(channelLight(response, channel, 0), gain * 0.003, 1e-15);
    EXPECT_NEAR(channelLight(response, channel, 1), gain, 1e-15);
    EXPECT_EQ(channelLight(response, channel, 0.04), channelLight(response, channel, 0));  // the flat foot
    for (int code = 13; code < 255; ++code) {
      EXPECT_LT(channelLight(response, channel, code / 255.0), channelLight(response, channel, (code + 1) / 255.0));
    }
  }
  response.toe = 0;
  response.black = 0;
  EXPECT_NEAR(channelLight(response, 1, 0.5), std::pow(0.5, 2.2), 1e-15);
}

TEST(SimulateLight, BrightestSpotOfTheRigHasRadianceOne) {
  const SimulatedWall wall(reportRig(8));
  double brightest = 0;
  for (std::size_t i = 0; i < wall.projectorCount(); ++i) {
    for (int k = 0; k < 625; ++k) {
      brightest = std::max(brightest, wall.radiance(i, {1024 * (k % 25) / 24.0, 768 * (k / 25) / 24.0}));
    }
  }
  EXPECT_NEAR(brightest, 1, 1e-9);
}

TEST(SimulateBlur, KernelHasTheVarianceAskedFor) {
  for (const double variance : {0.05, 0.17, 0.36, 1.0, 4.0}) {
    const auto kernel = gaussianKernel(variance);
    double sum = kernel[0];
    double measured = 0;
    for (std::size_t i = 1; i < kernel.size(); ++i) {
      sum += 2 * kernel[i];
      measured += 2 * kernel[i] * static_cast<double>(i * i);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_NEAR(measured, variance, 1e-4 * std::max(1.0, variance));
  }
  EXPECT_EQ(gaussianKernel(0).size(), 1U);
}

TEST(SimulateBlur, DefocusedPixelKeepsItsLightAndItsPlace) {
  SimulatedProjectorSpec spec = obliqueProjector(2000);
  spec.defocus = 0.7;
  Image8 frame(spec.resolution, 1);
  frame.at(40, 30) = 255;
  const LightImage light(spec, frame, LightImage::Leak::kWithout);
  double sum = 0;
  double atX = 0;
  double spread = 0;
  for (int y = 0; y < light.height(); ++y) {
    for (int x = 0; x < light.width(); ++x) {
      const double here = light.data()[(std::ptrdiff_t{y} * light.width() + x) * LightImage::kChannels];
      const double position = x - light.apron() + 0.5;
      sum += here;
      atX += here * position;
      spread += here * (position - 40.5) * (position - 40.5);
    }
  }
  EXPECT_NEAR(sum, 1 - spec.response.black, 1e-5);
  EXPECT_NEAR(atX / sum, 40.5, 1e-4);
  // Interpolated linearly (1/6) it must have the spread of a square pixel (1/12) and the defocus.
  EXPECT_NEAR(spread / sum + 1.0 / 6, 0.7 * 0.7 + 1.0 / 12, 1e-3);
}

TEST(SimulateLight, FramesOfTheWrongSizeAreRefused) {
  SimulatedWall wall(miniRig(2));
  EXPECT_THROW(wall.projector(0).show(plain({640, 481}, 255)), std::invalid_argument);
  EXPECT_THROW(wall.projector(0).show(Image8({640, 480}, 4)), std::invalid_argument);
  EXPECT_THROW((void)wall.audience({plain({10, 10}, 1)}, {0, 0}, {100, 100}, {64, 64}), std::invalid_argument);
}

}  // namespace
}  // namespace pixelflex::calib
