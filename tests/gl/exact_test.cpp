// Flat screens: what the renderer shows is the desktop, bit for bit or to a rounding.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "tests/support_image/image_near.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;
using testing::imageNear;

using ExactTest = testing::GlTest<>;

OutputPlan exactPlan(const std::string& name, Size resolution, Size desktop, glm::ivec2 at) {
  OutputPlan plan;
  plan.name = name;
  plan.resolution = resolution;
  plan.desktop = desktop;
  plan.exactAt = at;
  return plan;
}

Image8 cropped(const Image8& image, const Box& box) {
  Image8 part({box.right - box.left, box.bottom - box.top}, 3);
  const auto inside = intersect(box, boxOf(image.size()));
  for (int y = inside.top; y < inside.bottom; ++y) {
    for (int x = inside.left; x < inside.right; ++x) {
      for (int c = 0; c < 3; ++c) part.at(x - box.left, y - box.top, c) = image.at(x, y, c);
    }
  }
  return part;
}

TEST_F(ExactTest, CopiesBitForBit) {
  const auto desktop = testing::testDesktop({1024, 768});
  WallRenderer renderer(context_);
  EXPECT_TRUE(renderer.setPlans({exactPlan("a", desktop.size(), desktop.size(), {0, 0})}));
  renderer.upload(testing::wholeBatch(desktop));
  EXPECT_EQ(renderer.draw(), std::vector<std::size_t>{0});
  EXPECT_TRUE(imageNear(renderer.readOutput(0), desktop, 0, "exact-output"));
  EXPECT_TRUE(imageNear(renderer.readDesktop(), desktop, 0, "exact-desktop"));
}

TEST_F(ExactTest, IsDimmedAsAskedAndBitForBitAgain) {
  const auto desktop = testing::testDesktop({300, 200});
  OutputPlan warped =
      testing::planOf("b", testing::homographyMap({75, 53}, desktop.size()), {75, 53}, desktop.size(), 2, 1);
  WallRenderer renderer(context_);
  renderer.setPlans({exactPlan("a", desktop.size(), desktop.size(), {0, 0}), warped});
  renderer.upload(testing::wholeBatch(desktop));
  renderer.draw();
  const auto before = renderer.readOutput(1);
  renderer.setBrightness(0.25F);
  EXPECT_EQ(renderer.draw(), (std::vector<std::size_t>{0, 1}));
  Image8 dimmed = desktop;
  for (auto& sample : dimmed.samples()) {
    sample = static_cast<std::uint8_t>(std::lround(sample * std::pow(0.25, 1 / 2.2)));
  }
  EXPECT_TRUE(imageNear(renderer.readOutput(0), dimmed, 1, "dimmed"));
  EXPECT_FALSE(renderer.readOutput(1) == before);
  renderer.setBrightness(1);
  EXPECT_EQ(renderer.draw(), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(imageNear(renderer.readOutput(0), desktop, 0, "undimmed"));
  EXPECT_TRUE(imageNear(renderer.readOutput(1), before, 0, "undimmed-warped"));
}

TEST_F(ExactTest, CopiesBitForBitAcrossTileBordersAndBlackOutside) {
  const auto desktop = testing::testDesktop({3840, 2160});
  const std::vector<Box> screens{{0, 0, 1920, 1080},
                                 {1920, 0, 3840, 1080},
                                 {501, 499, 2502, 1503},
                                 {3000, 1700, 4001, 2301},
                                 {-40, -30, 600, 450}};
  std::vector<OutputPlan> plans;
  plans.reserve(screens.size());
  for (const auto& screen : screens) {
    plans.push_back(exactPlan("screen", {screen.right - screen.left, screen.bottom - screen.top}, desktop.size(),
                              {screen.left, screen.top}));
  }
  WallRenderer renderer(context_);
  renderer.setPlans(plans);
  renderer.upload(testing::wholeBatch(desktop));
  renderer.draw();
  for (std::size_t i = 0; i < screens.size(); ++i) {
    EXPECT_TRUE(imageNear(renderer.readOutput(i), cropped(desktop, screens[i]), 0, "exact-4k-" + std::to_string(i)));
  }
  EXPECT_TRUE(imageNear(renderer.readDesktop(), desktop, 0, "exact-4k-desktop"));
}

TEST_F(ExactTest, IdentityWarpIsTheDesktopToOneCode) {
  const auto desktop = testing::testDesktop({3840, 2160});
  WallRenderer renderer(context_);
  auto smooth = testing::planOf("smooth", testing::identityMap(), desktop.size(), desktop.size(), 1, 1);
  auto plain = smooth;
  plain.dither = false;
  auto linear = plain;
  linear.transfer = DesktopTransfer::kLinear;
  renderer.setPlans({smooth, plain, linear});
  renderer.upload(testing::wholeBatch(desktop));
  renderer.draw();
  EXPECT_TRUE(imageNear(renderer.readOutput(0), desktop, 1, "identity-dithered"));
  EXPECT_TRUE(imageNear(renderer.readOutput(1), desktop, 1, "identity"));
  EXPECT_TRUE(imageNear(renderer.readOutput(2), desktop, 1, "identity-linear"));
}

TEST_F(ExactTest, ChangedPartsFollow) {
  auto desktop = testing::testDesktop({2100, 1100});
  WallRenderer renderer(context_);
  renderer.setPlans(
      {exactPlan("a", {1100, 1100}, desktop.size(), {0, 0}), exactPlan("b", {1000, 1100}, desktop.size(), {1100, 0})});
  renderer.upload(testing::wholeBatch(desktop));
  renderer.draw();
  const Box moved{900, 980, 1050, 1060};
  for (int y = moved.top; y < moved.bottom; ++y) {
    for (int x = moved.left; x < moved.right; ++x) desktop.at(x, y, 1) = static_cast<std::uint8_t>(x ^ y);
  }
  renderer.upload(testing::batchOf(desktop, {moved}));
  EXPECT_EQ(renderer.draw(), std::vector<std::size_t>{0});
  EXPECT_TRUE(imageNear(renderer.readOutput(0), cropped(desktop, {0, 0, 1100, 1100}), 0, "exact-moved"));
  EXPECT_EQ(renderer.readDesktop(), desktop);
}

}  // namespace
}  // namespace pixelflex::viewer
