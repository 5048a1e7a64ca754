#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "calib/estimate/collineation.h"
#include "calib/estimate/projector_fit.h"
#include "calib/geometry/projector_mapping.h"
#include "calib/patterns/blob_fit.h"

namespace pixelflex::calib {
namespace {

TEST(Collineation, MapsFourPointsExactly) {
  // The report's equations 1 to 6: with 1, not 2, 3, 4, in the third columns.
  const std::vector<PointPair> pairs = {{{102.5, 99.1}, {0, 0}},
                                        {{1790.2, 130.4}, {3000, 0}},
                                        {{1755.9, 980.3}, {3000, 1500}},
                                        {{140.7, 1001.6}, {0, 1500}}};
  const Homography c = solveCollineation(pairs);
  for (const auto& pair : pairs) EXPECT_LT(glm::length(c.map(pair.source) - pair.target), 1e-8);
  EXPECT_LT(rmsError(c, pairs), 1e-8);
}

TEST(Collineation, StandsACameraOriginOnTheHorizon) {
  // a33 of the report's matrix would be zero here: wall = H camera with H[8] = 0.
  const Homography truth({1, 0.2, 5, 0.1, 1, 7, 0.001, 0.002, 0});
  std::vector<PointPair> pairs;
  for (const glm::dvec2 p :
       {glm::dvec2(500, 400), glm::dvec2(1500, 420), glm::dvec2(1480, 900), glm::dvec2(510, 950)}) {
    pairs.push_back({p, truth.map(p)});
  }
  const Homography c = solveCollineation(pairs);
  EXPECT_LT(glm::length(c.map({900, 700}) - truth.map({900, 700})), 1e-7);
}

TEST(Collineation, AveragesOverMoreThanFour) {
  const Homography truth({1.5, 0.1, 30, -0.1, 1.4, 20, 1e-4, -5e-5, 1});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.5);
  std::vector<PointPair> pairs;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      const glm::dvec2 p{150.0 * x, 100.0 * y};
      pairs.push_back({p, truth.map(p) + glm::dvec2(noise(random), noise(random))});
    }
  }
  const Homography c = solveCollineation(pairs);
  EXPECT_NEAR(rmsError(c, pairs), 0.5 * std::sqrt(2), 0.1);
  EXPECT_LT(glm::length(c.map({700, 450}) - truth.map({700, 450})), 0.2);
}

TEST(Collineation, RefusesTooFewAndDegenerate) {
  const std::vector<PointPair> three = {{{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}, {{0, 1}, {0, 1}}};
  EXPECT_THROW((void)solveCollineation(three), EstimateError);
  std::vector<PointPair> line;
  for (int i = 0; i < 5; ++i) line.push_back({{double(i), 2.0 * i}, {double(i), 2.0 * i}});
  EXPECT_THROW((void)solveCollineation(line), EstimateError);
}

ProjectorModel truth() {
  return {.projectorFromWall = {1.1e-3, 6e-5, -0.55, -4e-5, 1.05e-3, -0.30, 5e-5, 3e-5, 1},
          .centre = {530, 300},
          .scale = 1500,
          .radial = {-0.05, 0.03, -0.01},
          .tangential = {5e-4, -8e-4}};
}

std::vector<Sample> samplesOf(const ProjectorMapping& mapping, double noisePx, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noisePx);
  std::vector<Sample> samples;
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const glm::dvec2 p{25 + 974.0 * column / 9, 20 + 728.0 * row / 9};
      samples.push_back({p, *mapping.wallFromProjector(p + glm::dvec2(noise(random), noise(random)))});
    }
  }
  return samples;
}

TEST(ProjectorFit, RecoversTheMapOverTheWholeFrame) {
  const ProjectorMapping mapping(truth(), {1024, 768});
  const ProjectorFit exact = fitProjector(samplesOf(mapping, 0, 1), {1024, 768});
  EXPECT_LT(exact.quality.maximum, 2e-3);  // what the weak prior on the lens's centre leaves
  const ProjectorFit noisy = fitProjector(samplesOf(mapping, 0.03, 2), {1024, 768});
  EXPECT_LT(noisy.quality.rms, 0.06);
  const ProjectorMapping fitted(noisy.model, {1024, 768});
  double worst = 0;
  for (int y = 0; y <= 768; y += 32) {
    for (int x = 0; x <= 1024; x += 32) {
      const auto back = fitted.projectorFromWall(*mapping.wallFromProjector({x, y}));
      ASSERT_TRUE(back);
      worst = std::max(worst, glm::length(*back - glm::dvec2(x, y)));
    }
  }
  EXPECT_LT(worst, 0.12);  // the frame's corners, outside the samples; calibration reference 2 has 0.03-0.1
}

TEST(ProjectorFit, ShrugsOffAFewWildSamples) {
  const ProjectorMapping mapping(truth(), {1024, 768});
  auto samples = samplesOf(mapping, 0.02, 5);
  samples[17].pointInWall.x += 8;
  samples[63].pointInWall.y -= 11;
  const ProjectorMapping fitted(fitProjector(samples, {1024, 768}).model, {1024, 768});
  const auto back = fitted.projectorFromWall(*mapping.wallFromProjector({512, 384}));
  ASSERT_TRUE(back);
  EXPECT_LT(glm::length(*back - glm::dvec2(512, 384)), 0.1);
}

TEST(ProjectorFit, RefusesTooFewSamples) {
  const ProjectorMapping mapping(truth(), {1024, 768});
  auto samples = samplesOf(mapping, 0, 1);
  samples.resize(11);
  EXPECT_THROW((void)fitProjector(samples, {1024, 768}), EstimateError);
}

TEST(GaussianFit, FindsTheCentreBetweenPixels) {
  std::vector<LightSample> samples;
  for (int y = -12; y <= 12; ++y) {
    for (int x = -12; x <= 12; ++x) {
      const double r2 = (x - 0.37) * (x - 0.37) + (y + 1.21) * (y + 1.21);
      samples.push_back({{double(x), double(y)}, 0.02 + 0.7 * std::exp(-r2 / (2 * 3.5 * 3.5))});
    }
  }
  const auto fit = fitGaussian(samples, {{0, 0}, 4, 0.6, 0});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->centre.x, 0.37, 1e-5);
  EXPECT_NEAR(fit->centre.y, -1.21, 1e-5);
  EXPECT_NEAR(fit->sigma, 3.5, 1e-4);
  EXPECT_NEAR(fit->amplitude, 0.7, 1e-4);
}

TEST(GaussianFit, RefusesTooFewSamples) {
  const std::vector<LightSample> few(5);
  EXPECT_FALSE(fitGaussian(few, {{0, 0}, 4, 0.6, 0}));
}

}  // namespace
}  // namespace pixelflex::calib
