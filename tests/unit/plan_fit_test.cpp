// Where a desktop of another size than the wall's lies on it.
#include <gtest/gtest.h>

#include "viewer/plan/desktop_fit.h"

namespace pixelflex::viewer {
namespace {

using Place = std::pair<glm::dvec2, glm::dvec2>;  // the corners of what is shown

Place shownAt(const Placement& placement) {
  return {placement.wallFromDesktop({placement.shown.left, placement.shown.top}),
          placement.wallFromDesktop({placement.shown.right, placement.shown.bottom})};
}

TEST(PlanFit, ItsOwnSizeIsShownAsItIs) {
  for (const Fit fit : {Fit::kLetterbox, Fit::kStretch}) {
    EXPECT_EQ(placeDesktop({3418, 1287}, {3418, 1287}, {.fit = fit}), (Placement{{0, 0, 3418, 1287}}));
  }
}

TEST(PlanFit, TheAspectIsKeptAndTheRestShared) {
  const Placement wide = placeDesktop({1000, 800}, {2000, 1000}, {});
  EXPECT_EQ(wide.scale, glm::dvec2(0.5, 0.5));
  EXPECT_EQ(shownAt(wide), (Place{{0, 150}, {1000, 650}}));
  const Placement tall = placeDesktop({1000, 800}, {200, 400}, {});
  EXPECT_EQ(shownAt(tall), (Place{{300, 0}, {700, 800}}));
}

TEST(PlanFit, StretchedItFillsTheWall) {
  const Placement placement = placeDesktop({1000, 800}, {2000, 1000}, {.fit = Fit::kStretch});
  EXPECT_EQ(shownAt(placement), (Place{{0, 0}, {1000, 800}}));
}

TEST(PlanFit, WhatIsNotScaledLiesOnWholePixels) {
  const Placement placement = placeDesktop({1001, 600}, {400, 600}, {});
  EXPECT_EQ(placement.oneToOneAt(), glm::ivec2(300, 0));
  EXPECT_FALSE(placeDesktop({1001, 600}, {400, 599}, {}).oneToOneAt());
}

TEST(PlanFit, BarsThatNobodySeesAreFilled) {
  const Placement placement = placeDesktop({1999, 1000}, {4000, 2000}, {});
  EXPECT_EQ(shownAt(placement), (Place{{0, 0}, {1999, 1000}}));
  // 3418 x 1287 made smaller by 1.25.
  EXPECT_EQ(shownAt(placeDesktop({3418, 1287}, {2734, 1030}, {})), (Place{{0, 0}, {3418, 1287}}));
  EXPECT_NE(shownAt(placeDesktop({3418, 1287}, {2734, 1032}, {})), (Place{{0, 0}, {3418, 1287}}));
}

TEST(PlanFit, ARegionIsPlacedAsADesktopOfItsSize) {
  const Placement placement = placeDesktop({1000, 800}, {4000, 3000}, {.region = Box{1000, 500, 1500, 700}});
  EXPECT_EQ(placement.shown, (Box{1000, 500, 1500, 700}));
  EXPECT_EQ(shownAt(placement), (Place{{0, 200}, {1000, 600}}));
  EXPECT_EQ(placement.desktopFromWall({500, 400}), glm::dvec2(1250, 600));
}

TEST(PlanFit, ARegionThatTheDesktopLostIsCutOrLeftOut) {
  const FitOptions options{.region = Box{600, 0, 1200, 400}};
  EXPECT_EQ(placeDesktop({1000, 800}, {800, 600}, options).shown, (Box{600, 0, 800, 400}));
  EXPECT_EQ(placeDesktop({1000, 800}, {500, 400}, options).shown, (Box{0, 0, 500, 400}));
}

}  // namespace
}  // namespace pixelflex::viewer
