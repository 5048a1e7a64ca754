#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "calib/photometric/predicted_view.h"

namespace pixelflex::calib {
namespace {

using devices::Image16;
using devices::Image8;
using devices::ImageF;

constexpr std::array<std::uint8_t, 3> kWhite = {255, 255, 255};
constexpr std::array<std::uint8_t, 3> kBlack = {0, 0, 0};
constexpr devices::Size kFrame{200, 100};

ImageF evenWhite(glm::dvec3 light) {
  ImageF white({4, 2}, 3);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (int c = 0; c < 3; ++c) white.at(x, y, c) = static_cast<float>(light[c]);
    }
  }
  return white;
}

Image16 evenMap(devices::Size size, double value) {
  Image16 map(size, 1);
  for (auto& sample : map.samples()) sample = static_cast<std::uint16_t>(std::lround(value * 65535));
  return map;
}

ResponseCurve power(double exponent) {
  ResponseCurve curve;
  for (auto& channel : curve.light) {
    for (std::size_t code = 0; code < 256; ++code)
      channel.at(code) = std::pow(static_cast<double>(code) / 255, exponent);
  }
  return curve;
}

StoredLight plainLight(glm::dvec3 white) {
  StoredLight light;
  light.white = evenWhite(white);
  return light;
}

/// One projector pixel a millimetre, the frame's left edge at `left`.
ProjectorMapping frameAt(double left) {
  ProjectorModel model;
  model.projectorFromWall = {1, 0, -left, 0, 1, 0, 0, 0, 1};
  return {model, kFrame};
}

glm::dvec3 at(const ImageF& view, int x, int y) {
  return {view.at(x, y, 0), view.at(x, y, 1), view.at(x, y, 2)};
}

void expectLight(glm::dvec3 light, glm::dvec3 expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], expected[c], 1e-4 * std::max(1.0, expected[c])) << c;
}

TEST(PredictedProjector, UncorrectedItShowsCodesThroughItsResponse) {
  StoredLight light = plainLight({10, 20, 30});
  light.response = power(2);
  light.leak = 0.01;
  light.share = evenMap(kFrame, 0.5);
  light.gain = evenMap({3, 3}, 0.5);
  const PredictedProjector projector(light, Transfer::kSrgb);
  const auto place = projector.placeAt({0.5, 0.5});
  const double h = 0.01 + (51.0 / 255) * (51.0 / 255);
  expectLight(projector.lightOf(place, {51, 51, 51}, Correction::kNone), {10 * h, 20 * h, 30 * h});
}

TEST(PredictedProjector, CorrectedItsLightIsTheDesktopsTimesEachPart) {
  StoredLight light = plainLight({10, 20, 30});
  light.response = power(2.6);  // makes no difference any more
  light.leak = 0.01;
  light.share = evenMap(kFrame, 0.5);
  light.gain = evenMap({3, 3}, 0.8);
  light.lift = evenMap(kFrame, 0.5);
  light.largestLift = {0.04, 0.06, 0.02};
  light.colour = {0.9, 0, 0, 0, 1, 0, 0, 0.1, 0.8};
  const double grey = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
  const PredictedProjector projector(light, Transfer::kSrgb);
  const auto place = projector.placeAt({0.3, 0.7});
  const double h = 0.4 * 0.9 * grey;
  expectLight(projector.lightOf(place, {128, 128, 128}, Correction::kWhole),
              {10 * (0.03 + h), 20 * (0.04 + 0.4 * grey), 30 * (0.02 + h)});
  expectLight(projector.lightOf(place, {128, 128, 128}, Correction::kShares),
              {10 * (0.01 + 0.5 * grey), 20 * (0.01 + 0.5 * grey), 30 * (0.01 + 0.5 * grey)});
}

TEST(PredictedProjector, LinearTransferTakesCodesAsLight) {
  const PredictedProjector projector(plainLight({1, 1, 1}), Transfer::kLinear);
  expectLight(projector.lightOf(projector.placeAt({0.5, 0.5}), {51, 102, 255}, Correction::kWhole), {0.2, 0.4, 1});
}

TEST(PredictedProjector, PrimariesColourWhatEachChannelAdds) {
  StoredLight light = plainLight({100, 200, 300});
  // Of the mean white 2, 4, 8; at this place the white is 50 times that in red and green, 37.5 times in blue.
  light.primaries = Matrix3{1.5, 0.5, 0, 0.4, 3.2, 0.4, 0, 1, 7};
  const PredictedProjector projector(light, Transfer::kSrgb);
  const auto place = projector.placeAt({0.5, 0.5});
  expectLight(projector.lightOf(place, {255, 0, 0}, Correction::kWhole), {75, 20, 0});
  expectLight(projector.lightOf(place, kWhite, Correction::kWhole), {100, 200, 300});
}

TEST(PredictedProjector, NoMoreThanWhiteAndNoLessThanBlack) {
  StoredLight light = plainLight({1, 1, 1});
  light.colour = {1.5, 0, 0, -1, 1, 0, 0, 0, 1};
  const PredictedProjector projector(light, Transfer::kSrgb);
  expectLight(projector.lightOf(projector.placeAt({0.5, 0.5}), {255, 0, 0}, Correction::kWhole), {1, 0, 0});
}

/// Samples of the white stand in the middles of its cells.
TEST(PredictedProjector, WhiteIsStretchedOverTheFrame) {
  StoredLight light = plainLight({1, 1, 1});
  for (int x = 0; x < 4; ++x) light.white.at(x, 0) = light.white.at(x, 1) = static_cast<float>(x);
  const PredictedProjector projector(light, Transfer::kSrgb);
  EXPECT_NEAR(projector.placeAt({0.5, 0.5}).white.x, 1.5, 1e-6);
  EXPECT_NEAR(projector.placeAt({0.25 + 0.125, 0.1}).white.x, 1, 1e-6);
  EXPECT_NEAR(projector.placeAt({1, 1}).white.x, 3, 1e-6);
}

class TwoProjectors : public ::testing::Test {
 protected:
  /// 200 wide each, the second 150 to the right of the first; 10 mm of wall a raster pixel.
  TwoProjectors() {
    for (std::size_t i = 0; i < 2; ++i) {
      StoredLight light = plainLight({1, 1, 1});
      light.leak = 0.002;
      light.share = evenMap(kFrame, 1);
      for (int x = 0; x < kFrame.width; ++x) {
        const double wall = x + 0.5 + (i == 0 ? 0 : 150);
        const double ramp = std::clamp((wall - 150) / 50, 0.0, 1.0);
        for (int y = 0; y < kFrame.height; ++y) {
          light.share.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * (i == 0 ? 1 - ramp : ramp)));
        }
      }
      projectors_.emplace_back(light, Transfer::kSrgb);
      mappings_.push_back(frameAt(150.0 * static_cast<double>(i)));
    }
  }
  std::vector<PredictedProjector> projectors_;
  std::vector<ProjectorMapping> mappings_;
  WallRaster raster_{{0, 0}, 10, {35, 10}};
};

TEST_F(TwoProjectors, AreTwiceAsBrightWhereTheyOverlapUntilMasked) {
  const PredictedView view(projectors_, mappings_, raster_);
  const ImageF before = view.seeField(kWhite, Correction::kNone);
  expectLight(at(before, 5, 5), glm::dvec3(1.002));
  expectLight(at(before, 17, 5), glm::dvec3(2.004));
  expectLight(at(before, 30, 5), glm::dvec3(1.002));
  const ImageF after = view.seeField(kWhite, Correction::kWhole);
  for (int x = 0; x < 35; ++x) {
    EXPECT_NEAR(after.at(x, 5), x >= 15 && x < 20 ? 1.004 : 1.002, 1e-4) << x;
  }
}

TEST_F(TwoProjectors, LeakAddsUpInBlackWhateverTheMasks) {
  const PredictedView view(projectors_, mappings_, raster_);
  const ImageF black = luminanceOf(view.seeField(kBlack, Correction::kWhole));
  EXPECT_NEAR(black.at(5, 5), 0.002, 1e-6);
  EXPECT_NEAR(black.at(17, 5), 0.004, 1e-6);
}

TEST_F(TwoProjectors, AFrameBorderInsideAPixelLightsPartOfIt) {
  const PredictedView view(projectors_, mappings_, {{-4, -20}, 10, {3, 3}});
  const ImageF seen = view.seeField(kWhite, Correction::kNone);
  EXPECT_NEAR(seen.at(0, 2), 0.6 * 1.002, 1e-5);
  EXPECT_NEAR(seen.at(1, 2), 1.002, 1e-5);
  EXPECT_NEAR(seen.at(1, 0), 0, 1e-6);
}

TEST_F(TwoProjectors, ADesktopIsSeenWhereItStandsAndOffsetsMoveIt) {
  const WallRaster raster{{100, 20}, 1, {150, 60}};
  const PredictedView view(projectors_, mappings_, raster);
  Image8 desktop(raster.size, 3);
  for (int c = 0; c < 3; ++c) desktop.at(75, 30, c) = desktop.at(10, 30, c) = 255;
  const ImageF right = view.see(desktop, Correction::kWhole);
  EXPECT_NEAR(right.at(75, 30), 1.004, 1e-3);
  EXPECT_NEAR(right.at(74, 30), 0.004, 1e-3);
  const std::vector<glm::dvec2> offsets = {{0, 0}, {0, 2}};
  const ImageF doubled = view.see(desktop, Correction::kWhole, offsets);
  EXPECT_NEAR(doubled.at(75, 30), 0.49 + 0.004, 0.011);
  EXPECT_NEAR(doubled.at(75, 32), 0.51 + 0.004, 0.011);
  EXPECT_NEAR(doubled.at(10, 30), 1.002, 1e-3);  // the first alone
}

}  // namespace
}  // namespace pixelflex::calib
