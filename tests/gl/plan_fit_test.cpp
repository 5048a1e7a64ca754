// Desktops of other sizes than the wall's, drawn: every pixel of flat screens against a picture made by hand, and
// warped frames against the model.
#include <gtest/gtest.h>

#include "calib/geometry/projector_mapping.h"
#include "devices/display/gl_context.h"
#include "tests/gl/bent_frames.h"
#include "tests/gl/plans.h"
#include "viewer/plan/pointer_map.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;

/// Two screens of 300x200 side by side.
WallPlan flatWall(const FitOptions& fit) {
  calib::Calibration calibration;
  for (int i = 0; i < 2; ++i) {
    calib::ProjectorCalibration screen;
    screen.name = "p" + std::to_string(i + 1);
    screen.resolution = {300, 200};
    screen.model.projectorFromWall = {1, 0, -300.0 * i, 0, 1, 0, 0, 0, 1};
    screen.flatAt = glm::ivec2(300 * i, 0);
    calibration.projectors.push_back(screen);
  }
  calibration.display = calib::Display{0, 0, 600, 200, {600, 200}};
  calib::Wall wall;
  wall.desktop.filter = calib::DesktopFilter::kNearest;
  return {{}, wall, calibration, {}, fit};
}

class PlanFitTest : public ::testing::Test {
 protected:
  Image8 show(const WallPlan& wall, const Image8& desktop) {
    WallRenderer renderer(context_);
    renderer.setPlans(wall.outputsFor(desktop.size()));
    renderer.upload(testing::wholeBatch(desktop));
    renderer.draw();
    Image8 whole({600, 200}, 3);
    for (int i = 0; i < 2; ++i) {
      const Image8 part = renderer.readOutput(static_cast<std::size_t>(i));
      for (int y = 0; y < 200; ++y) std::ranges::copy(part.row(y), whole.row(y).begin() + std::ptrdiff_t{900} * i);
    }
    return whole;
  }
  /// `desktop`'s part with every pixel `times` as large, at a place of a black wall.
  static Image8 expected(const Image8& desktop, const Box& part, int times, glm::ivec2 at) {
    Image8 whole({600, 200}, 3);
    for (int y = 0; y < part.height() * times; ++y) {
      for (int x = 0; x < part.width() * times; ++x) {
        for (int c = 0; c < 3; ++c) {
          whole.at(at.x + x, at.y + y, c) = desktop.at(part.left + x / times, part.top + y / times, c);
        }
      }
    }
    return whole;
  }
  devices::HeadlessContext context_;
};

TEST_F(PlanFitTest, ASmallerDesktopOfTheSameHeightIsShownPixelForPixel) {
  const Image8 desktop = testing::testDesktop({401, 200});
  EXPECT_TRUE(show(flatWall({}), desktop) == expected(desktop, {0, 0, 401, 200}, 1, {99, 0}));
}

TEST_F(PlanFitTest, AHalfSizedDesktopIsDoubled) {
  const Image8 desktop = testing::testDesktop({250, 100});
  EXPECT_TRUE(show(flatWall({}), desktop) == expected(desktop, {0, 0, 250, 100}, 2, {50, 0}));
}

TEST_F(PlanFitTest, ARegionIsShownAloneAcrossTiles) {
  const Image8 desktop = testing::testDesktop({1400, 1200});
  const Box plain{900, 950, 1300, 1150};
  EXPECT_TRUE(show(flatWall({.region = plain}), desktop) == expected(desktop, plain, 1, {100, 0}));
  const Box small{1000, 1000, 1300, 1050};
  EXPECT_TRUE(show(flatWall({.region = small}), desktop) == expected(desktop, small, 2, {0, 50}));
}

TEST_F(PlanFitTest, StretchedNothingStaysBlack) {
  const Image8 white = [] {
    Image8 image({100, 100}, 3);
    std::ranges::fill(image.samples(), std::uint8_t{255});
    return image;
  }();
  Image8 full({600, 200}, 3);
  std::ranges::fill(full.samples(), std::uint8_t{255});
  EXPECT_TRUE(show(flatWall({.fit = Fit::kStretch}), white) == full);
}

TEST_F(PlanFitTest, ThePointerIsWhereItsPixelIs) {
  const WallPlan wall = flatWall({});
  const PointerMap map(wall, {250, 100});
  EXPECT_EQ(map.fromProjector(0, {50.1, 0.1}), glm::ivec2(0, 0));
  EXPECT_EQ(map.fromProjector(0, {53.9, 3.9}), glm::ivec2(1, 1));
  EXPECT_EQ(map.fromProjector(1, {249.9, 199.9}), glm::ivec2(249, 99));
  EXPECT_EQ(map.fromProjector(0, {3, 100}), glm::ivec2(0, 50)) << "held on the desktop";
  const PointerMap part(flatWall({.region = Box{1000, 1000, 1300, 1050}}), {1400, 1200});
  EXPECT_EQ(part.fromProjector(0, {0.5, 50.5}), glm::ivec2(1000, 1000));
  EXPECT_EQ(part.fromProjector(1, {299.5, 149.5}), glm::ivec2(1299, 1049));
  EXPECT_EQ(part.fromProjector(1, {299.5, 199.5}), glm::ivec2(1299, 1049));
}

/// Each pixel of a warped frame shows the place of the desktop that the model says, or none.
TEST_F(PlanFitTest, AWarpedFrameShowsALetterboxedRegion) {
  calib::Calibration calibration;
  calibration.projectors = {testing::projectorOf(testing::Model::kAll)};
  const calib::Display display = testing::displayOf(testing::Place::kDisplayCutsFrame);
  calibration.display = display;
  const Size desktop{2400, 1800};
  const Box region{900, 200, 1900, 500};
  const WallPlan wall({}, {}, calibration, {}, {.region = region});
  WallRenderer renderer(context_, {.measure = true});
  renderer.setPlans(wall.outputsFor(desktop));
  devices::ImageF coordinates(desktop, 4);
  for (int y = 0; y < desktop.height; ++y) {
    for (int x = 0; x < desktop.width; ++x) {
      coordinates.at(x, y, 0) = static_cast<float>(x) + 0.5F;
      coordinates.at(x, y, 1) = static_cast<float>(y) + 0.5F;
    }
  }
  renderer.uploadDesktop(coordinates);
  renderer.draw();
  const auto frame = renderer.readOutputFloat(0);
  const calib::ProjectorMapping mapping(calibration.projectors.front());
  // By hand: the region keeps its aspect and lies in the display's middle.
  const glm::dvec2 room(display.resolution.width, display.resolution.height);
  const double scale = std::min(room.x / 1000, room.y / 300);
  const glm::dvec2 corner = glm::floor((room - scale * glm::dvec2(1000, 300)) / 2.0);
  const glm::dvec2 unit{(display.right - display.left) / room.x, (display.bottom - display.top) / room.y};
  std::int64_t shown = 0;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const auto inWall = mapping.wallFromProjector({x + 0.5, y + 0.5});
      ASSERT_TRUE(inWall);
      const glm::dvec2 p =
          ((*inWall - glm::dvec2(display.left, display.top)) / unit - corner) / scale + glm::dvec2(900, 200);
      const double depth = std::min({p.x - region.left, region.right - p.x, p.y - region.top, region.bottom - p.y});
      if (std::abs(depth) < 0.1) continue;
      ASSERT_EQ(frame.at(x, y, 3), depth > 0 ? 1 : 0) << x << ", " << y;
      if (depth < 0) continue;
      ASSERT_NEAR(frame.at(x, y, 0), p.x, 0.02);
      ASSERT_NEAR(frame.at(x, y, 1), p.y, 0.02);
      ++shown;
    }
  }
  EXPECT_GT(shown, 10000);
}

}  // namespace
}  // namespace pixelflex::viewer
