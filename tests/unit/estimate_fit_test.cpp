#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "calib/estimate/projector_fit.h"
#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {
namespace {

constexpr devices::Size kFrame{1024, 768};

ProjectorModel lens() {
  return {.projectorFromWall = {1.1e-3, 6e-5, -0.55, -4e-5, 1.05e-3, -0.30, 5e-5, 3e-5, 1},
          .centre = {530, 300},
          .scale = 1500,
          .radial = {-0.05, 0.03, -0.01},
          .tangential = {5e-4, -8e-4}};
}

/// A lattice of measured points; `wall` says where a point of the frame truly lands.
std::vector<Sample> latticeOf(const std::function<glm::dvec2(glm::dvec2)>& wall, int columns, int rows, double noisePx,
                              unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noisePx);
  std::vector<Sample> samples;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 p{15 + 994.0 * column / (columns - 1), 15 + 738.0 * row / (rows - 1)};
      samples.push_back({p, wall(p + glm::dvec2(noise(random), noise(random)))});
    }
  }
  return samples;
}

double rmsOverFrame(const ProjectorModel& model, const std::function<glm::dvec2(glm::dvec2)>& wall) {
  const ProjectorMapping fitted(model, kFrame);
  double squares = 0;
  int count = 0;
  for (int y = 0; y <= 768; y += 32) {
    for (int x = 0; x <= 1024; x += 32) {
      const auto back = fitted.projectorFromWall(wall({x, y})).value_or(glm::dvec2(1e6));
      const glm::dvec2 off = back - glm::dvec2(x, y);
      squares += glm::dot(off, off);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

std::function<glm::dvec2(glm::dvec2)> planeOf(const ProjectorMapping& mapping) {
  return [&mapping](glm::dvec2 p) { return mapping.wallFromProjector(p).value_or(glm::dvec2(0)); };
}

/// Where the ray of a distorted pixel of a pinhole at (300, 500, -1800) meets a cylinder of radius 3000 around
/// (0, y, -3000), by steps along the ray: arithmetic of its own.
glm::dvec2 onCylinder(glm::dvec2 pixel) {
  const glm::dvec2 n = (pixel - glm::dvec2(500, 420)) / 1600.0;
  const glm::dvec2 bent = n * (1 + 0.04 * glm::dot(n, n));
  const glm::dvec3 along = glm::normalize(glm::dvec3(bent.x + 0.05, bent.y - 0.02, 1 - 0.05 * bent.x));
  const glm::dvec3 eye(300, 500, -1800);
  double low = 0;
  double high = 6000;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    const glm::dvec3 at = eye + along * middle;
    (std::hypot(at.x, at.z + 3000) < 3000 ? low : high) = middle;
  }
  const glm::dvec3 at = eye + along * low;
  return {3000 * std::atan2(at.x, at.z + 3000), at.y};
}

TEST(ProjectorFit, OfABentScreenIsAsGoodAsOfAPlane) {
  const auto samples = latticeOf(onCylinder, 10, 10, 0.03, 1);
  const ProjectorFit flat = fitProjector(samples, kFrame);
  const ProjectorFit bent = fitProjector(samples, kFrame, BentScreen{3000, 100});
  EXPECT_LT(rmsOverFrame(bent.model, onCylinder), 0.04);
  EXPECT_FALSE(bent.model.residual);
  EXPECT_GT(rmsOverFrame(flat.model, onCylinder), 3 * rmsOverFrame(bent.model, onCylinder));
}

TEST(ProjectorFit, ASplineTakesWhatTheLensLeaves) {
  // A lens with a ripple that no Brown polynomial has.
  const ProjectorMapping ideal(lens(), kFrame);
  const auto rippled = [&](glm::dvec2 p) {
    const glm::dvec2 off(0.8 * std::sin(p.x / 170) * std::cos(p.y / 210), 0.6 * std::sin(p.y / 150 + 1));
    return ideal.wallFromProjector(p + off).value_or(glm::dvec2(0));
  };
  const ProjectorFit blobs = fitProjector(latticeOf(rippled, 10, 10, 0.02, 2), kFrame);
  ASSERT_TRUE(blobs.model.residual);
  EXPECT_LT(blobs.quality.heldOut, 0.2);
  EXPECT_LT(rmsOverFrame(blobs.model, rippled), 0.12);
  const ProjectorFit dense = fitProjector(latticeOf(rippled, 40, 30, 0.02, 3), kFrame);
  ASSERT_TRUE(dense.model.residual);
  EXPECT_LT(rmsOverFrame(dense.model, rippled), 0.02);
}

TEST(ProjectorFit, NoSplineIsKeptForNoise) {
  const ProjectorMapping ideal(lens(), kFrame);
  int kept = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    if (fitProjector(latticeOf(planeOf(ideal), 10, 10, 0.03, seed), kFrame).model.residual) ++kept;
  }
  EXPECT_LE(kept, 1);
}

TEST(ProjectorFit, ItsOwnFiguresTellTheTruth) {
  const ProjectorMapping ideal(lens(), kFrame);
  double heldOut = 0;
  double predicted = 0;
  double actual = 0;
  constexpr int kTrials = 10;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const ProjectorFit fit = fitProjector(latticeOf(planeOf(ideal), 10, 10, 0.05, seed), kFrame);
    heldOut += fit.quality.heldOut / kTrials;
    predicted += fit.quality.deviation / kTrials;
    actual += rmsOverFrame(fit.model, planeOf(ideal)) / kTrials;
  }
  EXPECT_NEAR(heldOut, 0.05 * std::sqrt(2.0), 0.02);  // of a sample: its own noise on two axes, and the model's
  EXPECT_GT(predicted, 0.5 * actual);
  EXPECT_LT(predicted, 2 * actual);
}

}  // namespace
}  // namespace pixelflex::calib
