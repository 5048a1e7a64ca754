// Pairs of projectors that show an eye each.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <optional>

#include "devices/display/gl_context.h"
#include "tests/support_calibration/plain_wall.h"
#include "viewer/model/stereo_picture.h"
#include "viewer/model/triangle_soup.h"
#include "viewer/plan/model_wall.h"

namespace pixelflex::viewer {
namespace {

/// A square of a tenth of a unit before or behind the window and a wide one far behind both.
Scene target(float depth) {
  TriangleSoup soup;
  const auto add = [&](float half, float z) {
    for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
      soup.push_back({.position = {half * corner, z}, .normal = {0, 0, 1}});
    }
  };
  add(0.1F, depth);
  add(1, -1);
  add(1, 1e-3F - 1);
  Scene scene;
  scene.materials.emplace_back();
  addToScene(soup, 0, scene);
  return scene;
}

/// The mean place, x, of the pixels that show the small square.
double placeOf(const devices::ImageF& frame, float depth) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      if (frame.at(x, y, 3) < 0.5F || std::abs(frame.at(x, y, 2) - depth) > 0.01F) continue;
      sum += x + 0.5;
      ++count;
    }
  }
  EXPECT_GT(count, 50);
  return count > 0 ? sum / count : 0;
}

class StereoTest : public ::testing::TestWithParam<int> {
 protected:
  /// Two projectors in one place.
  StereoTest() {
    auto& all = wall_.calibration.projectors;
    const auto name = all[1].name;
    all[1] = all[0];
    all[1].name = name;
    wall_.wall.blend.stack = calib::StackRule::kLeftRight;
  }
  calib::PlainWall wall_;
  devices::HeadlessContext context_;
};

TEST_P(StereoTest, EachEyeHasItsOwnPicture) {
  const WallPlan plan("/nowhere", wall_.wall, wall_.calibration, {});
  EXPECT_EQ(eyesOfProjectors(plan), (std::vector<Eye>{Eye::kLeft, Eye::kRight}));
  const WallPlan right("/nowhere", wall_.wall, wall_.calibration, {wall_.calibration.projectors[1].name});
  EXPECT_EQ(eyesOfProjectors(right), (std::vector<Eye>{Eye::kRight}));
  ModelWall model(context_, plan, {.passes = GetParam(), .model = {.measure = true}});
  const auto window = windowOf(plan.display());
  for (const float depth : {0.5F, -0.5F}) {
    model.setScene(target(depth));
    ModelView view{.window = window, .viewer = centredViewer(window), .pose = {.zoom = 0.6}};
    view.viewer.eyeDistance = 100;
    model.setView(view);
    EXPECT_TRUE(model.draw());
    const double disparity = placeOf(model.readFloat(1), depth) - placeOf(model.readFloat(0), depth);
    // Before the wall the right eye sees things further left. The middle of the bounds is in the window.
    const double scale = windowFromModel(view.pose, model.bounds(), window)[0].x;
    const double z = scale * (depth - model.bounds().middle().z);
    const double expected = -100 * z / (view.viewer.eye.z - z) * plan.desktop().width / window.extent.x;
    EXPECT_NEAR(disparity, expected, 1.0) << depth;
    EXPECT_FALSE(model.draw());
  }
}

INSTANTIATE_TEST_SUITE_P(Passes, StereoTest, ::testing::Values(1, 2));

TEST(StereoPicture, HoldsBothEyes) {
  TriangleSoup soup;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), {1, -1}, {0, 1}}) soup.push_back({.position = {corner, 0}});
  Scene scene;
  scene.materials.push_back({.colour = {1, 1, 1}, .lit = false});
  addToScene(soup, 0, scene);
  devices::HeadlessContext context;
  const devices::Size size{80, 40};
  std::vector<ModelOutput> outputs(2, ModelOutput{.light = {.name = "eye", .resolution = size}});
  outputs[0].eye = Eye::kLeft;
  outputs[1].eye = Eye::kRight;
  ModelRenderer renderer(context, outputs, {.samples = 1});
  renderer.setScene(std::move(scene));
  renderer.setView(
      {.window = {{80, 40}}, .viewer = {.eye = {0, 0, 100}, .eyeDistance = 30}, .pose = {.shift = {0, 0, 0.5}}});
  renderer.draw();
  const auto left = renderer.readOutput(0);
  const auto right = renderer.readOutput(1);
  ASSERT_FALSE(left == right);
  StereoPicture stereo(context, size);
  stereo.draw(renderer.outputTexture(0), renderer.outputTexture(1), StereoKind::kAnaglyph);
  const auto anaglyph = stereo.read();
  stereo.draw(renderer.outputTexture(0), renderer.outputTexture(1), StereoKind::kSideBySide);
  const auto halves = stereo.read();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      ASSERT_EQ(anaglyph.at(x, y, 0), left.at(x, y, 0));
      ASSERT_EQ(anaglyph.at(x, y, 2), right.at(x, y, 2));
      const auto& eye = x < 40 ? left : right;
      const int mean = (eye.at(2 * (x % 40), y, 1) + eye.at(2 * (x % 40) + 1, y, 1)) / 2;
      ASSERT_NEAR(halves.at(x, y, 1), mean, 1);
    }
  }
}

}  // namespace
}  // namespace pixelflex::viewer
