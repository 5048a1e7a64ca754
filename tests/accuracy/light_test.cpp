#include <gtest/gtest.h>

#include <iostream>

#include "calib/simulate/rig_generator.h"
#include "tests/accuracy/light_measurement.h"

namespace pixelflex::calib {
namespace {

/// A small wall of three unlike projectors, photographed again: what the light table shows of larger ones.
LightFigures figuresOfThree() {
  const LightRig three{.name = "three", .make = [](auto seed) {
                         return withUnlikeLight(casualRig(3, 1, {640, 480}, seed, {1280, 720}), seed);
                       }};
  LightFigures figures;
  measureLight(three, 4, true, [&](Figure figure, Correction correction, double value, const std::string& where) {
    figures.add(figure, correction, value, where);
  });
  return figures;
}

TEST(Light, OfUnlikeProjectorsIsThatOfOneWall) {
  const LightFigures figures = figuresOfThree();
  std::cout << figures.table();
  for (const auto figure : {Figure::kStep16, Figure::kStep32, Figure::kStep64, Figure::kStep128, Figure::kStep200,
                            Figure::kStep255, Figure::kUnevenness, Figure::kBlack, Figure::kBlackStep, Figure::kGrey,
                            Figure::kPrimaries, Figure::kSlipped, Figure::kBanding16, Figure::kBanding64}) {
    EXPECT_TRUE(figures.met(figure)) << LightFigures::told(figure, Correction::kMatched,
                                                           figures.worst(figure, Correction::kMatched));
  }
  EXPECT_GT(figures.worst(Figure::kWhite, Correction::kMatched),
            0.4 * figures.worst(Figure::kWhite, Correction::kNone));
  // Without correction it is patchy, by the report's method banded.
  EXPECT_GT(figures.worst(Figure::kStep128, Correction::kNone), 0.3);
  EXPECT_GT(figures.worst(Figure::kStep16, Correction::kReport), 0.1);
  for (const auto figure : {Figure::kStep128, Figure::kUnevenness, Figure::kGradient, Figure::kBlack, Figure::kGrey}) {
    for (const auto other : {Correction::kNone, Correction::kReport}) {
      EXPECT_GT(figures.worst(figure, other), 2 * figures.worst(figure, Correction::kMatched))
          << LightFigures::told(figure, other, figures.worst(figure, other));
    }
  }
}

}  // namespace
}  // namespace pixelflex::calib
