// The plans of calibrated projectors through the renderer: nothing missing, and no trace of the tiles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "devices/display/gl_context.h"
#include "tests/gl/bent_frames.h"
#include "tests/gl/mesh_count.h"
#include "tests/gl/plans.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {
namespace {

using testing::depthInDisplay;
using testing::displayOf;
using testing::kFrame;
using testing::Model;
using testing::Place;
using testing::projectorOf;

class PlanTest : public ::testing::Test {
 protected:
  static std::vector<OutputPlan> plansOf(Model model, const calib::Display& display) {
    calib::Calibration calibration;
    calibration.projectors = {projectorOf(model)};
    calibration.display = display;
    auto plans = WallPlan({}, {}, calibration, {}).outputsFor(display.resolution);
    plans[0].dither = false;
    return plans;
  }
  devices::Image8 draw(const std::vector<OutputPlan>& plans, const devices::Image8& desktop) {
    WallRenderer renderer(context_);
    renderer.setPlans(plans);
    renderer.upload(testing::wholeBatch(desktop));
    renderer.draw();
    return renderer.readOutput(0);
  }
  devices::HeadlessContext context_;
};

/// The renderer's own drawing reaches exactly the pixels that are counted once.
TEST_F(PlanTest, TheRendererDrawsWhatIsCovered) {
  auto display = displayOf(Place::kDisplayCutsFrame);
  display.resolution = {3100, 2400};  // four tiles by three
  const auto plans = plansOf(Model::kAll, display);
  const auto count = testing::countTriangles(plans[0].mesh, kFrame);
  EXPECT_GT(plans[0].mesh.patches.size(), 8U);
  WallRenderer renderer(context_, {.measure = true});
  renderer.setPlans(plans);
  renderer.uploadDesktop(devices::ImageF(display.resolution, 4));
  renderer.draw();
  const auto frame = renderer.readOutputFloat(0);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      ASSERT_EQ(frame.at(x, y, 3), static_cast<float>(count.at(x, y))) << x << ", " << y;
    }
  }
}

int apart(const devices::Image8& a, const devices::Image8& b, int x, int y) {
  int most = 0;
  for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.at(x, y, c) - b.at(x, y, c)));
  return most;
}

/// The same picture in the same place of the wall, once as a desktop of a single tile, once as the corner of a larger
/// desktop where four tiles meet in its middle.
TEST_F(PlanTest, TiledDrawingIsUntiledDrawing) {
  const calib::Display small{103, 81.5, 897, 702, {1016, 794}};
  const auto picture = testing::testDesktop(small.resolution);
  const glm::ivec2 moved(kTileStride - 511, kTileStride - 402);
  calib::Display large = small;
  large.resolution = {small.resolution.width + moved.x, small.resolution.height + moved.y};
  large.left -= moved.x * (small.right - small.left) / small.resolution.width;
  large.top -= moved.y * (small.bottom - small.top) / small.resolution.height;
  devices::Image8 around(large.resolution, 3);
  for (int y = 0; y < picture.height(); ++y) {
    std::ranges::copy(picture.row(y), around.row(y + moved.y).begin() + 3 * std::ptrdiff_t{moved.x});
  }
  for (const Model model : {Model::kKeystone, Model::kShortThrow, Model::kBent, Model::kAll}) {
    const auto onePlan = plansOf(model, small);
    const auto fourPlans = plansOf(model, large);
    EXPECT_EQ(onePlan[0].mesh.patches.size(), 1U);
    EXPECT_EQ(fourPlans[0].mesh.patches.size(), 4U);
    const auto untiled = draw(onePlan, picture);
    const auto tiled = draw(fourPlans, around);
    const calib::ProjectorMapping mapping(projectorOf(model));
    std::int64_t compared = 0;
    std::int64_t beyondOne = 0;
    int worst = 0;
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        if (depthInDisplay(mapping, small, x, y) < 3) continue;  // there the filter reaches past the border
        ++compared;
        const int difference = apart(tiled, untiled, x, y);
        beyondOne += difference > 1 ? 1 : 0;
        worst = std::max(worst, difference);
      }
    }
    EXPECT_GT(compared, kFrame.area() / 2);
    // The picture has lines of one pixel at full contrast. Where a lens bends the mesh, a triangle cut by a tile's
    // border moves them by up to a hundredth of a pixel: a pixel in a hundred thousand may differ by two codes.
    EXPECT_LE(static_cast<double>(beyondOne), model == Model::kKeystone ? 0 : 1e-5 * static_cast<double>(compared));
    EXPECT_LE(worst, 2);
  }
}

}  // namespace
}  // namespace pixelflex::viewer
