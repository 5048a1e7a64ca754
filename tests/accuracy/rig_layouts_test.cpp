#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

constexpr int kGrid = 20;

/// The share of a projector's frame that another one lights too.
double sharedPart(const SimulatedWall& room, std::size_t own, std::size_t other) {
  const auto& projectors = room.rig().projectors;
  int inside = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int row = i / kGrid;
    const glm::dvec2 part((i % kGrid + 0.5) / kGrid, (row + 0.5) / kGrid);
    const devices::Size size = projectors[own].resolution;
    const auto wall = room.wallFromProjector(own, part * glm::dvec2(size.width, size.height));
    const auto there = wall ? room.projectorFromWall(other, *wall) : std::nullopt;
    if (there && there->x > 0 && there->y > 0 && there->x < projectors[other].resolution.width &&
        there->y < projectors[other].resolution.height) {
      ++inside;
    }
  }
  return inside / double{kGrid * kGrid};
}

/// The wall's vector for a projector's whole row or column.
glm::dvec2 span(const SimulatedWall& room, std::size_t projector, bool column) {
  const devices::Size size = room.rig().projectors[projector].resolution;
  const glm::dvec2 middle(size.width / 2.0, size.height / 2.0);
  const glm::dvec2 half = column ? glm::dvec2(0, middle.y) : glm::dvec2(middle.x, 0);
  return room.wallFromProjector(projector, middle + half).value() -
         room.wallFromProjector(projector, middle - half).value();
}

TEST(RigLayouts, StackedPairsCoverEachOther) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const SimulatedWall room(stackedRig(seed));
    ASSERT_EQ(room.projectorCount(), 8U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(sharedPart(room, i, i + 4), 0.85) << "seed " << seed;
    EXPECT_GT(sharedPart(room, 0, 1), 0.1);
    EXPECT_LT(sharedPart(room, 0, 1), 0.32);
  }
}

TEST(RigLayouts, PortraitProjectorsStandOnTheirSides) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const SimulatedWall room(portraitRig(seed));
    ASSERT_EQ(room.projectorCount(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 row = span(room, i, false);
      EXPECT_GT(std::abs(row.y), 10 * std::abs(row.x)) << "seed " << seed;
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      EXPECT_GT(sharedPart(room, i, i + 1), 0.08) << "seed " << seed;
      EXPECT_LT(sharedPart(room, i, i + 1), 0.32) << "seed " << seed;
    }
  }
}

TEST(RigLayouts, ShortThrowsAreShiftedAndBent) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Rig rig = shortThrowRig(seed);
    const SimulatedWall room(rig);
    ASSERT_EQ(rig.projectors.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& optics = rig.projectors[i].optics;
      EXPECT_NEAR(optics.focal / 1280, 0.8, 0.06);
      EXPECT_EQ(std::abs(optics.principal.y - 400), 400);
      EXPECT_GE(optics.radial[0], -0.15);
      EXPECT_LE(optics.radial[0], -0.1);
      for (const glm::dvec2 corner :
           {glm::dvec2(0, 0), glm::dvec2(1280, 0), glm::dvec2(1280, 800), glm::dvec2(0, 800)}) {
        EXPECT_TRUE(room.wallFromProjector(i, corner)) << "seed " << seed << " projector " << i;
      }
    }
    EXPECT_GT(sharedPart(room, 0, 1), 0.08) << "seed " << seed;
    EXPECT_GT(sharedPart(room, 0, 2), 0.08) << "seed " << seed;
  }
}

TEST(RigLayouts, AnInsetIsThreeTimesAsDense) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const SimulatedWall room(insetRig(seed));
    ASSERT_EQ(room.projectorCount(), 2U);
    EXPECT_EQ(sharedPart(room, 1, 0), 1) << "seed " << seed;
    EXPECT_NEAR(glm::length(span(room, 0, false)) / glm::length(span(room, 1, false)), 3, 0.3);
  }
}

}  // namespace
}  // namespace pixelflex::calib
