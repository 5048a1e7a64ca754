#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/accuracy/light_figures.h"
#include "tests/accuracy/report_light.h"
#include "tests/accuracy/text_likeness.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

ImageF noise(devices::Size size, unsigned seed) {
  ImageF image(size, 1);
  for (float& sample : image.samples()) {
    seed = seed * 1664525U + 1013904223U;
    sample = static_cast<float>(seed >> 24U);
  }
  return image;
}

/// The definition, for the only window of an 11 x 11 picture.
double similarityOfWindow(const ImageF& first, const ImageF& second) {
  double total = 0, meanA = 0, meanB = 0, squareA = 0, squareB = 0, product = 0;
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 11; ++x) {
      const double weight = std::exp(-(std::pow(x - 5, 2) + std::pow(y - 5, 2)) / 4.5);
      const double a = first.at(x, y), b = second.at(x, y);
      total += weight;
      meanA += weight * a, meanB += weight * b;
      squareA += weight * a * a, squareB += weight * b * b, product += weight * a * b;
    }
  }
  meanA /= total, meanB /= total;
  const double varianceA = squareA / total - meanA * meanA, varianceB = squareB / total - meanB * meanB;
  const double covariance = product / total - meanA * meanB;
  constexpr double kC1 = 6.5025, kC2 = 58.5225;
  return (2 * meanA * meanB + kC1) / (meanA * meanA + meanB * meanB + kC1) * (2 * covariance + kC2) /
         (varianceA + varianceB + kC2);
}

TEST(TextLikeness, IsTheStructuralSimilarityOfTheDefinition) {
  const ImageF first = noise({11, 11}, 1), second = noise({11, 11}, 2);
  EXPECT_NEAR(structuralSimilarity(first, second), similarityOfWindow(first, second), 1e-4);
  EXPECT_NEAR(structuralSimilarity(first, first), 1, 1e-6);
  const ImageF large = noise({40, 30}, 3);
  EXPECT_NEAR(structuralSimilarity(large, large), 1, 1e-6);
}

TEST(TextLikeness, OfTheDesktopItselfIsWhole) {
  const Image8 text = [] {
    Image8 picture({7, 5}, 1);
    std::ranges::fill(picture.samples(), std::uint8_t{255});
    picture.at(3, 2) = 0;
    return picture;
  }();
  const Image8 desktop = textDesktop(text, {50, 40});
  EXPECT_EQ(desktop.at(10, 7, 1), 0);
  ImageF light(desktop.size(), 1);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) light.at(x, y) = desktop.at(x, y) == 0 ? 0 : 0.37F;
  }
  EXPECT_NEAR(likenessToDesktop(light, 0.37, desktop), 1, 1e-5);
}

TEST(ReportMethod, MultipliesEightBitsAndLooksUpACode) {
  ReportLight light{Image8({1, 1}, 1), {}};
  light.mask.at(0, 0) = 64;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 256; ++i) light.table.at(c).at(i) = static_cast<std::uint8_t>(255 - i + c);
  }
  ImageF warped({1, 1}, 4);
  for (int c = 0; c < 3; ++c) warped.at(0, 0, c) = 10 / 255.0F;
  const Image8 frame = reportFrame(warped, light);  // 10 * 64 / 255 is 2.5 and becomes 3
  EXPECT_EQ(frame.at(0, 0, 0), 252);
  EXPECT_EQ(frame.at(0, 0, 2), 254);
}

TEST(ReportMethod, HasFewStepsOfLightForDarkTones) {
  Image8 desktop({2, 1}, 4);
  desktop.at(0, 0, 0) = 16;  // 1.32 of 255 steps of light
  desktop.at(1, 0, 0) = 255;
  const ImageF light = reportDesktop(desktop);
  EXPECT_FLOAT_EQ(light.at(0, 0, 0), 1 / 255.0F);
  EXPECT_EQ(light.at(1, 0, 0), 1);
}

TEST(LightFigures, TellTheWorstAndWhetherItIsGoodEnough) {
  LightFigures figures;
  EXPECT_TRUE(figures.met());
  for (const double value : {0.002, 0.001, 0.004}) figures.add(Figure::kStep128, Correction::kMatched, value, "a");
  figures.add(Figure::kStep128, Correction::kNone, 0.7, "b");
  EXPECT_TRUE(figures.met(Figure::kStep128));
  EXPECT_NE(figures.table().find("0.20 % / 0.40 % | 70.00 % | - | met | a"), std::string::npos) << figures.table();
  figures.add(Figure::kText, Correction::kMatched, 0.83, "c");
  EXPECT_FALSE(figures.met(Figure::kText));
  EXPECT_FALSE(figures.met());
  EXPECT_EQ(figures.worst(Figure::kText, Correction::kMatched), 0.83);
}

}  // namespace
}  // namespace pixelflex::calib
