#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib/photometric/mask.h"
#include "calib/photometric/stacks.h"

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
    const auto mask = alphaMask(i, projectors, densities, {});
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        const auto inWall = projectors[i].wallFromProjector({x + 0.5, y + 0.5});
        ASSERT_TRUE(inWall);
        const double share = blendShares(*inWall, projectors, densities, {})[i];
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
  const auto mask = alphaMask(0, projectors, std::vector<double>{1, 40}, {});
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

/// A wide projector, 800 wall units across, and a small one of three times its density in its middle, poking out below.
class InsetTest : public ::testing::Test {
 protected:
  static ProjectorMapping frameAt(glm::dvec2 corner, double density) {
    return {ProjectorModel{
                .projectorFromWall = {1, 0, -corner.x, 0, 1, -corner.y, 0, 0, 1}, .centre = {0, 0}, .scale = density},
            {400, 300}};
  }
  const std::vector<ProjectorMapping> projectors_ = {frameAt({0, 0}, 0.5), frameAt({300, 520}, 1.5)};
  const std::vector<double> densities_{0.5, 1.5};
  const MaskRules rules_{.densityExponent = 2, .priorityFeather = 60};

  [[nodiscard]] std::vector<double> at(double x, double y) const {
    return blendShares({x, y}, projectors_, densities_, rules_);
  }
};

TEST_F(InsetTest, TheDenseOneWinsWithARampOfTheWidthAskedFor) {
  const std::vector<ProjectorMapping> inside = {projectors_[0], frameAt({300, 200}, 1.5)};
  const auto shareAt = [&](double x) { return blendShares({x, 300}, inside, densities_, rules_); };
  EXPECT_NEAR(shareAt(300.001)[1], 0, 1e-6);
  EXPECT_NEAR(shareAt(320)[1], 0.5, 0.01);  // 30 of its pixels from its left border, a step's middle
  EXPECT_EQ(shareAt(340.1)[1], 1);
  EXPECT_EQ(shareAt(340.1)[0], 0);
}

TEST_F(InsetTest, SharesSumToOneWhereTheInsetPokesOut) {
  for (double y = 515; y < 719; y += 1.7) {
    for (double x = 280; x < 580; x += 3.1) {
      const auto shares = at(x, y);
      const bool lit = y < 600 || (x > 300 && x < 300 + 400 / 1.5);
      EXPECT_NEAR(shares[0] + shares[1], lit ? 1 : 0, 1e-12) << x << " " << y;
    }
  }
}

TEST_F(InsetTest, NeighboursOfOneDensityBlendAsEver) {
  const std::vector<ProjectorMapping> pair = {frameAt({0, 0}, 1), frameAt({300, 0}, 1.2)};
  const std::vector<double> densities{1, 1.2};
  for (double x = 301; x < 400; x += 9) {
    EXPECT_EQ(blendShares({x, 150}, pair, densities, rules_), blendShares({x, 150}, pair, densities, {}));
  }
}

TEST(Stacks, FindsThePairsThatLightTheSame) {
  const auto frameAt = [](glm::dvec2 corner) {
    return ProjectorMapping(
        ProjectorModel{.projectorFromWall = {1, 0, -corner.x, 0, 1, -corner.y, 0, 0, 1}, .centre = {0, 0}, .scale = 1},
        {400, 300});
  };
  const std::vector<ProjectorMapping> wall = {frameAt({0, 0}), frameAt({350, 0}), frameAt({5, 3}), frameAt({700, 0}),
                                              frameAt({352, -4})};
  const auto partners = stackPartners(wall);
  EXPECT_EQ(partners[0], 2U);
  EXPECT_EQ(partners[2], 0U);
  EXPECT_EQ(partners[1], 4U);
  EXPECT_EQ(partners[3], std::nullopt);
}

}  // namespace
}  // namespace pixelflex::calib
