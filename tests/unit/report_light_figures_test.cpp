#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "calib/report/light_drawing.h"
#include "calib/report/light_figures.h"
#include "calib/report/overlap_profile.h"
#include "tests/unit/report_lit_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image16;
using devices::ImageF;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Evenness, OfAFieldWithAStep) {
  ImageF field({80, 40}, 1);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 80; ++x) field.at(x, y) = x < 40 ? 0.9F : 1.1F;
  }
  const Evenness step = evennessOf(field, 8);
  EXPECT_NEAR(step.rms, 0.1, 1e-6);
  EXPECT_NEAR(step.range, 0.2, 1e-6);
  EXPECT_NEAR(step.steepest, 0.2 / 0.9, 1e-6);
}

TEST(Evenness, OfASlope) {
  ImageF field({160, 20}, 1);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 160; ++x) field.at(x, y) = static_cast<float>(std::exp(0.002 * x));
  }
  EXPECT_NEAR(evennessOf(field, 8).steepest, 0.016, 1e-4);
}

TEST(Evenness, WhatIsNotLitDoesNotCount) {
  ImageF field({20, 20}, 1);
  for (int y = 5; y < 15; ++y) {
    for (int x = 5; x < 15; ++x) field.at(x, y) = 3;
  }
  const Evenness even = evennessOf(field, 4);
  EXPECT_DOUBLE_EQ(even.rms, 0);
  EXPECT_DOUBLE_EQ(even.range, 0);
  EXPECT_DOUBLE_EQ(even.steepest, 0);
}

TEST(LightFigures, MatchedProjectorsHaveOneWhite) {
  LitWall lit(3);
  const auto before = lit.light().value();
  EXPECT_GT(compareColours(before, Correction::kNone).whiteWorst, 3);
  EXPECT_FALSE(before.matched);
  lit.match();
  const auto after = lit.light().value();
  EXPECT_TRUE(after.matched);
  EXPECT_GT(compareColours(after, Correction::kNone).whiteWorst, 3);
  EXPECT_LT(compareColours(after, Correction::kWhole).whiteWorst, 0.01);
  EXPECT_FALSE(compareColours(after, Correction::kWhole).primariesRms);
}

TEST(LightFigures, PrimariesAreComparedWhereTheyAreKnown) {
  LitWall lit;
  for (auto& projector : lit.plain.calibration.projectors) {
    projector.measured.value().primariesKnown = true;
    const double crosstalk = projector.name == "p1" ? 0.02 : 0.1;
    projector.measured.value().primaries = {1, crosstalk, 0, crosstalk, 1, crosstalk, 0, crosstalk, 1};
  }
  const auto light = lit.light().value();
  const auto figures = compareColours(light, Correction::kNone);
  ASSERT_TRUE(figures.primariesRms);
  EXPECT_GT(figures.primariesRms.value(), 2);
}

TEST(WallLight, OfAStackForTwoEyesIsTheLeftEyes) {
  LitWall lit(2);
  lit.plain.wall.blend.stack = StackRule::kLeftRight;
  lit.plain.calibration.projectors[1].model = lit.plain.calibration.projectors[0].model;
  const auto light = lit.light().value();
  EXPECT_TRUE(light.leftEye);
  EXPECT_THAT(light.names, ::testing::ElementsAre("p1"));
}

TEST(WhiteFromPicture, UnseenNodesTakeTheMeanOfTheirNeighbours) {
  Image16 picture({5, 3}, 3);
  for (int c = 0; c < 3; ++c) {
    picture.at(0, 1, c) = 20000;
    picture.at(1, 1, c) = 40000;
  }
  picture.at(4, 2, 0) = 9;  // seen in one channel alone: not seen
  const auto white = whiteFromPicture(picture, 65.535).value();
  EXPECT_NEAR(white.at(0, 1, 2), 20, 1e-4);
  EXPECT_NEAR(white.at(0, 0, 1), 30, 1e-4);
  EXPECT_NEAR(white.at(2, 0, 1), 40, 1e-4);
  EXPECT_NEAR(white.at(4, 2, 0), 40, 1e-4);
  EXPECT_FALSE(whiteFromPicture(Image16({4, 4}, 3), 1));
  EXPECT_FALSE(whiteFromPicture(Image16({4, 4}, 1), 1));
}

class Overlap : public ::testing::Test {
 protected:
  static ProjectorMapping square(glm::dvec2 corner, int side, double turn = 0) {
    ProjectorModel model;
    const double c = std::cos(turn), s = std::sin(turn);
    model.projectorFromWall = {c, s, -c * corner.x - s * corner.y, -s, c, s * corner.x - c * corner.y, 0, 0, 1};
    return {model, {side, side}};
  }
};

TEST_F(Overlap, ItsLineRunsAcrossWhereItIsNarrow) {
  const Display display{0, 0, 1850, 1000, {1850, 1000}};
  const auto line = lineAcross(square({850, 0}, 1000), square({0, 0}, 1000), display).value();
  EXPECT_NEAR(line.middle.x, 925, 2);
  EXPECT_NEAR(line.middle.y, 500, 2);
  EXPECT_NEAR(line.along.x, 1, 1e-6);
  EXPECT_NEAR(line.at(line.overlapBegin).x, 850, 2);
  EXPECT_NEAR(line.at(line.overlapEnd).x, 1000, 2);
  EXPECT_NEAR(line.at(line.begin).x, 760, 4);
  EXPECT_NEAR(line.at(line.end).x, 1090, 4);
}

TEST_F(Overlap, OfCornersRunsFromMiddleToMiddle) {
  const Display display{0, 0, 1800, 1800, {1800, 1800}};
  const auto line = lineAcross(square({0, 0}, 1000), square({800, 800}, 1000), display).value();
  EXPECT_NEAR(line.along.x, std::numbers::sqrt2 / 2, 1e-3);
  EXPECT_NEAR(line.along.y, std::numbers::sqrt2 / 2, 1e-3);
}

TEST_F(Overlap, TurnedWithTheProjectors) {
  const double turn = 0.3;
  const glm::dvec2 way(std::cos(turn), std::sin(turn));
  const Display display{-1000, -1000, 3000, 3000, {4000, 4000}};
  const auto line = lineAcross(square({0, 0}, 1000, turn), square(800.0 * way, 1000, turn), display).value();
  EXPECT_NEAR(line.along.x, way.x, 0.02);
  EXPECT_NEAR(line.along.y, way.y, 0.02);
}

TEST_F(Overlap, AnInsetsLineEndsInTheOtherProjector) {
  const Display display{0, 0, 1000, 1000, {1000, 1000}};
  const auto line = lineAcross(square({0, 0}, 1000), square({400, 450}, 100), display).value();
  EXPECT_NEAR(line.overlapEnd - line.overlapBegin, 100, 8);
  EXPECT_LT(line.begin, line.overlapBegin - 40);
}

TEST_F(Overlap, NoneOutsideTheDisplay) {
  const Display display{0, 0, 800, 1000, {800, 1000}};
  EXPECT_FALSE(lineAcross(square({850, 0}, 1000), square({0, 0}, 1000), display));
}

TEST_F(Overlap, ProfileOfAMatchedWallIsFlat) {
  LitWall lit;
  lit.match();
  const auto light = lit.light().value();
  const auto line = lineAcross(light.mappings[0], light.mappings[1], lit.plain.calibration.display.value()).value();
  const double dim = 90 * (1 - 0.2 * kCameraLuminance[2]);  // luminance of the common white
  const Profile after = profileAlong(line, light, Correction::kWhole);
  ASSERT_EQ(after.parts.size(), 2u);
  for (const double sum : after.sum) EXPECT_NEAR(sum, dim, 0.01 * dim);
  const Profile before = profileAlong(line, light, Correction::kNone);
  EXPECT_NEAR(before.sum.front(), 180 * 1.002, 0.1);
  EXPECT_NEAR(before.sum.back(), dim * 1.002, 0.1);
  EXPECT_NEAR(before.sum[before.sum.size() / 2], (180 + dim) * 1.002, 0.1);
}

TEST_F(Overlap, DifferenceOfUnlikeAndOfMatchedProjectors) {
  LitWall lit;
  lit.match();
  const auto light = lit.light().value();
  const auto line = lineAcross(light.mappings[0], light.mappings[1], lit.plain.calibration.display.value()).value();
  const auto unlike = differenceOver(line, 0, 1, light, Correction::kNone);
  const double second = 0.5 * (1 - 0.2 * kCameraLuminance[2]);
  EXPECT_NEAR(unlike.luminance, 2 * (1 - second) / (1 + second), 1e-3);
  EXPECT_GT(unlike.colour, 3);
  const auto alike = differenceOver(line, 0, 1, light, Correction::kWhole);
  EXPECT_LT(alike.luminance, 0.001);
  EXPECT_LT(alike.colour, 0.01);
}

TEST(ResponseDrawing, FindsThePower) {
  EXPECT_NEAR(gammaOf(LitWall::power(2.2)), 2.2, 1e-9);
  EXPECT_NEAR(gammaOf(LitWall::power(1.8)), 1.8, 1e-9);
}

TEST(ResponseDrawing, APowerOfTheScaleIsAStraightLine) {
  const std::string svg = drawResponse(LitWall::power(2.2), "p1");
  EXPECT_THAT(svg, HasSubstr("class=\"line red\" d=\"M0.0 75.0L"));
  EXPECT_THAT(svg, HasSubstr("L20.4 59.7L"));  // code 52: 20.39 % of the width, 20.39 % of the height
  EXPECT_THAT(svg, HasSubstr("L100.0 0.0\""));
}

TEST(MapDrawing, IsStretchedBetweenItsBounds) {
  Image16 map({2, 1}, 1);
  map.at(0, 0) = 32768;
  map.at(1, 0) = 49151;
  const MapDrawing drawing = drawStretched(map, "Gain");
  EXPECT_NEAR(drawing.least, 0.5, 1e-4);
  EXPECT_NEAR(drawing.most, 0.75, 1e-4);
  EXPECT_THAT(drawing.picture, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(drawStretched({}, "Gain").picture, IsEmpty());
}

}  // namespace
}  // namespace pixelflex::calib
