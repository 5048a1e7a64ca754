#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/photometric/mask.h"

namespace pixelflex::calib {
namespace {

/// A frame with its middle at a wall point, turned and magnified, keystoned, with barrel distortion.
ProjectorModel model(glm::dvec2 middle, double turn, double pixelsPerUnit) {
  const double c = std::cos(turn) * pixelsPerUnit / 1000;
  const double s = std::sin(turn) * pixelsPerUnit / 1000;
  return {.projectorFromWall = {c, s, -c * middle.x - s * middle.y, -s, c, s * middle.x - c * middle.y, 6e-5, -4e-5,
                                1 - 6e-5 * middle.x + 4e-5 * middle.y},
          .centre = {170, 120},
          .scale = 1000,
          .radial = {-0.3, 0.05, 0}};
}

/// Every pixel against equation 7 evaluated for all projectors at its wall point.
void expectSharesEverywhere(const std::vector<ProjectorMapping>& projectors) {
  std::vector<double> densities;
  for (const auto& projector : projectors) densities.push_back(projector.meanDensity());
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const auto mask = alphaMask(i, projectors, densities, 2);
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        const auto inWall = projectors[i].wallFromProjector({x + 0.5, y + 0.5});
        ASSERT_TRUE(inWall);
        const double share = blendShares(*inWall, projectors, densities, 2)[i];
        ASSERT_NEAR(mask.at(x, y), share * 65535, 0.5001) << i << ": " << x << ", " << y;
      }
    }
  }
}

constexpr devices::Size kFrame{331, 243};

TEST(MaskBlocks, TurnedNeighboursAndOneTooFarAway) {
  expectSharesEverywhere(
      {ProjectorMapping(model({150, 120}, 0.05, 1), kFrame), ProjectorMapping(model({400, 140}, 1.5, 1), kFrame),
       ProjectorMapping(model({260, 330}, -0.4, 0.8), kFrame), ProjectorMapping(model({1500, 120}, 0, 1), kFrame)});
}

TEST(MaskBlocks, AnInsetSmallerThanABlock) {
  const std::vector<ProjectorMapping> projectors = {ProjectorMapping(model({150, 120}, 0.05, 1), kFrame),
                                                    ProjectorMapping(model({153, 117}, 0.3, 40), kFrame)};
  expectSharesEverywhere(projectors);
  const auto mask = alphaMask(0, projectors, std::vector<double>{1, 40}, 2);
  EXPECT_LT(*std::ranges::min_element(mask.samples()), 600);  // the inset is there, and has nearly all the light
}

TEST(MaskBlocks, BentScreensAndResiduals) {
  auto left = model({150, 120}, 0, 1);
  auto right = model({380, 130}, 0.1, 1);
  for (auto* one : {&left, &right}) {
    one->bend = Bend{.radius = 900, .apex = 260, .depth = {0, 0, 4e-4}};
    one->residual = ResidualSpline{.columns = 2, .rows = 1, .control = std::vector<glm::dvec2>(20, {0.4, -0.3})};
    one->residual->control[7] = {-0.5, 0.9};
  }
  expectSharesEverywhere({ProjectorMapping(left, kFrame), ProjectorMapping(right, kFrame)});
}

}  // namespace
}  // namespace pixelflex::calib
