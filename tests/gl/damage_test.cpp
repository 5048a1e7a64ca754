// What is uploaded and drawn, and above all what is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "tests/support_image/image_near.h"
#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;

using DamageTest = testing::GlTest<>;

/// Left and right half of the desktop, one projector each, a little turned.
std::vector<OutputPlan> twoHalves(Size desktop) {
  const Size resolution{320, 240};
  std::vector<OutputPlan> plans;
  for (int i = 0; i < 2; ++i) {
    const Size half{desktop.width / 2, desktop.height};
    const auto inHalf = testing::homographyMap(resolution, half);
    const double shift = i * half.width;
    const testing::WeightedMap map = [=](glm::dvec2 p) {
      const auto at = inHalf(p);
      return glm::dvec3(at.x + shift * at.z, at.y, at.z);
    };
    plans.push_back(testing::planOf(i == 0 ? "left" : "right", map, resolution, desktop, 4, 3));
  }
  return plans;
}

TEST_F(DamageTest, NothingMarkedIsNoWork) {
  const Size desktop{1500, 700};
  const auto picture = testing::testDesktop(desktop);
  WallRenderer renderer(context_);
  renderer.setPlans(twoHalves(desktop));
  renderer.upload(testing::wholeBatch(picture));
  EXPECT_EQ(renderer.draw().size(), 2U);
  const auto before = renderer.stats();
  renderer.upload(testing::batchOf(picture, {}));
  EXPECT_FALSE(renderer.needsDraw());
  EXPECT_TRUE(renderer.draw().empty());
  const auto after = renderer.stats();
  EXPECT_EQ(after.bytesUploaded, before.bytesUploaded);
  EXPECT_EQ(after.outputsDrawn, before.outputsDrawn);
  EXPECT_EQ(after.pixelsDrawn, before.pixelsDrawn);
  EXPECT_EQ(after.frames, before.frames);
}

TEST_F(DamageTest, OnlyTheOutputsTouchedAreDrawnAndOnlyThere) {
  const Size desktop{1500, 700};
  auto picture = testing::testDesktop(desktop);
  WallRenderer renderer(context_);
  renderer.setPlans(twoHalves(desktop));
  renderer.upload(testing::wholeBatch(picture));
  renderer.draw();
  const auto before = renderer.stats();
  renderer.upload(testing::batchOf(picture, {{1200, 300, 1210, 310}}));
  EXPECT_THAT(renderer.draw(), ::testing::ElementsAre(1));
  const auto after = renderer.stats();
  EXPECT_EQ(after.bytesUploaded - before.bytesUploaded, 400U);
  // Ten desktop pixels are about six of the projector's; the filter and rounding add a few each way.
  EXPECT_LE(after.pixelsDrawn - before.pixelsDrawn, 20U * 20U);
  EXPECT_GE(after.pixelsDrawn - before.pixelsDrawn, 25U);
}

TEST_F(DamageTest, HalfAnUpdateIsNeverShown) {
  const Size desktop{640, 480};
  const auto picture = testing::testDesktop(desktop);
  WallRenderer renderer(context_);
  renderer.setPlans(twoHalves(desktop));
  renderer.upload(testing::wholeBatch(picture));
  renderer.draw();
  auto first = testing::batchOf(picture, {{140, 220, 204, 284}});
  first.completesUpdate = false;
  renderer.upload(first);
  EXPECT_FALSE(renderer.needsDraw());
  EXPECT_TRUE(renderer.draw().empty());
  renderer.upload(testing::batchOf(picture, {{470, 230, 490, 250}}));
  EXPECT_TRUE(renderer.needsDraw());
  EXPECT_FALSE(renderer.draw().empty());
}

TEST_F(DamageTest, ApronsFollowTheirNeighbours) {
  const Size desktop{2100, 1100};
  auto picture = testing::testDesktop(desktop);
  WallRenderer renderer(context_);
  renderer.setPlans(twoHalves(desktop));
  renderer.upload(testing::wholeBatch(picture));
  // Every pixel of the cross where the tiles meet, one box at a time.
  const auto fresh = testing::testDesktop(desktop, 9);
  std::vector<Box> boxes;
  for (int x = kTileStride - 3; x < kTileStride + 3; ++x) boxes.push_back({x, 0, x + 1, desktop.height});
  for (int y = kTileStride - 3; y < kTileStride + 3; ++y) boxes.push_back({0, y, desktop.width, y + 1});
  for (const auto& box : boxes) {
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        for (int c = 0; c < 3; ++c) picture.at(x, y, c) = fresh.at(x, y, c);
      }
    }
    renderer.upload(testing::batchOf(picture, {box}));
    renderer.draw();
  }
  WallRenderer whole(context_);
  whole.setPlans(twoHalves(desktop));
  whole.upload(testing::wholeBatch(picture));
  whole.draw();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(testing::imageNear(renderer.readOutput(i), whole.readOutput(i), 0, "aprons-" + std::to_string(i)));
  }
}

TEST_F(DamageTest, TwoFarCornersOfALargeDesktopAreTwoSmallUploads) {
  const Size desktop{16384, 8192};
  WallRenderer renderer(context_);
  OutputPlan plan;
  plan.name = "corner";
  plan.resolution = {640, 480};
  plan.desktop = desktop;
  plan.exactAt = glm::ivec2(desktop.width - 640, desktop.height - 480);
  renderer.setPlans({plan});
  Batch batch;
  batch.desktop = desktop;
  batch.completesUpdate = true;
  batch.boxes = {{0, 0, 64, 64}, {desktop.width - 64, desktop.height - 64, desktop.width, desktop.height}};
  for (int i = 0; i < 2 * 64 * 64; ++i) {
    for (const int code : {i % 251, i % 83, i % 17, 0}) batch.pixels.push_back(static_cast<std::byte>(code));
  }
  renderer.upload(batch);
  EXPECT_LE(renderer.stats().bytesUploaded, 64U * 1024U);
  EXPECT_EQ(renderer.draw().size(), 1U);
  const auto frame = renderer.readOutput(0);
  for (const int i : {0, 63, 64, 4095}) {
    const int number = 4096 + i;
    EXPECT_EQ(frame.at(640 - 64 + i % 64, 480 - 64 + i / 64, 0), number % 251);
    EXPECT_EQ(frame.at(640 - 64 + i % 64, 480 - 64 + i / 64, 2), number % 17);
  }
  EXPECT_EQ(frame.at(0, 0, 0), 0);
}

TEST_F(DamageTest, ADesktopThatNoDriverHoldsIsAnError) {
  OutputPlan plan;
  plan.name = "p";
  plan.resolution = {64, 64};
  plan.desktop = {60000, 60000};
  plan.exactAt = glm::ivec2(0, 0);
  WallRenderer renderer(context_);
  try {
    renderer.setPlans({plan});
    FAIL() << "accepted";
  } catch (const RendererError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("60000x60000"));
  }
  EXPECT_TRUE(renderer.draw().empty());
}

TEST_F(DamageTest, PlansThatAreNotSoundAreErrorsAndTheOldOnesStay) {
  const Size desktop{640, 480};
  const auto sound = twoHalves(desktop);
  WallRenderer renderer(context_);
  renderer.setPlans(sound);
  renderer.upload(testing::wholeBatch(testing::testDesktop(desktop)));
  std::vector<OutputPlan> wrong(9, sound[0]);
  wrong[0].mesh.indices[0] = 1U << 20;
  wrong[1].mesh.vertices[0].w = 0;
  wrong[2].mesh.patches[0].layer = 99;
  wrong[3].mesh.patches[0].indexCount += 3000;
  wrong[4].alpha = devices::Image16({3, 3}, 1);
  wrong[5].inverseResponse[0] = {0, 1};
  wrong[6].resolution = {0, 5};
  wrong[7].mesh.vertices[0].x = std::numeric_limits<float>::quiet_NaN();
  wrong[8].resolution = {1 << 20, 5};
  for (const auto& plan : wrong) EXPECT_THROW(renderer.setPlans({plan}), RendererError);
  auto otherDesktop = sound;
  otherDesktop[1].desktop = {640, 481};
  EXPECT_THROW(renderer.setPlans(otherDesktop), RendererError);
  EXPECT_THROW(renderer.setPlans({}), RendererError);
  EXPECT_EQ(renderer.draw().size(), 2U);
}

TEST_F(DamageTest, AnUpdateWithTooFewBytesIsAnError) {
  const Size desktop{640, 480};
  WallRenderer renderer(context_);
  renderer.setPlans(twoHalves(desktop));
  auto batch = testing::wholeBatch(testing::testDesktop(desktop));
  batch.pixels.pop_back();
  EXPECT_THROW(renderer.upload(batch), RendererError);
}

TEST_F(DamageTest, NewPlansKeepTheDesktop) {
  const Size desktop{640, 480};
  const auto picture = testing::testDesktop(desktop);
  WallRenderer renderer(context_);
  EXPECT_TRUE(renderer.setPlans(twoHalves(desktop)));
  renderer.upload(testing::wholeBatch(picture));
  EXPECT_FALSE(renderer.setPlans({twoHalves(desktop)[1]}));
  EXPECT_EQ(renderer.readDesktop(), picture);
  EXPECT_EQ(renderer.draw().size(), 1U);
  EXPECT_TRUE(renderer.setPlans(twoHalves({644, 480})));
}

TEST_F(DamageTest, TheCursorIsDrawnMovedAndLeavesNoTrace) {
  const Size desktop{640, 480};
  const auto picture = testing::testDesktop(desktop);
  OutputPlan flat;
  flat.name = "flat";
  flat.resolution = desktop;
  flat.desktop = desktop;
  flat.exactAt = glm::ivec2(0, 0);
  auto plans = twoHalves(desktop);
  plans.push_back(flat);
  WallRenderer renderer(context_);
  renderer.setPlans(plans);
  renderer.upload(testing::wholeBatch(picture));
  renderer.draw();
  std::vector<Image8> without;
  for (std::size_t i = 0; i < plans.size(); ++i) without.push_back(renderer.readOutput(i));

  Image8 arrow({8, 8}, 4);
  for (int i = 0; i < 8; ++i) {
    arrow.at(i, i, 0) = 200;
    arrow.at(i, i, 3) = 255;
  }
  renderer.setCursor(arrow, {1, 1});
  renderer.moveCursor({101, 201});
  EXPECT_THAT(renderer.draw(), ::testing::Contains(2));
  auto expected = picture;
  for (int i = 0; i < 8; ++i) {
    expected.at(100 + i, 200 + i, 0) = 200;
    expected.at(100 + i, 200 + i, 1) = 0;
    expected.at(100 + i, 200 + i, 2) = 0;
  }
  EXPECT_TRUE(testing::imageNear(renderer.readOutput(2), expected, 0, "cursor"));
  EXPECT_NE(renderer.readOutput(0), without[0]);
  EXPECT_EQ(renderer.readDesktop(), picture);

  renderer.moveCursor({500, 230});
  renderer.draw();
  EXPECT_TRUE(testing::imageNear(renderer.readOutput(0), without[0], 0, "cursor-left"));
  EXPECT_NE(renderer.readOutput(1), without[1]);
  const auto pixels = renderer.stats().pixelsDrawn;
  renderer.moveCursor({502, 230});
  renderer.draw();
  EXPECT_LE(renderer.stats().pixelsDrawn - pixels, 1500U);
  renderer.showCursor(false);
  renderer.draw();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    EXPECT_TRUE(testing::imageNear(renderer.readOutput(i), without[i], 0, "cursor-hidden-" + std::to_string(i)));
  }
}

}  // namespace
}  // namespace pixelflex::viewer
