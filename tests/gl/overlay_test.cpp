// What lies over a projector's frame: it is there, and nothing of it stays.
#include <gtest/gtest.h>

#include <array>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "tests/support_image/image_near.h"
#include "viewer/renderer/text_panel.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;

constexpr Size kSize{320, 240};

class OverlayTest : public testing::GlTest<> {
 protected:
  void show() {
    OutputPlan exact;
    exact.name = "exact";
    exact.resolution = exact.desktop = kSize;
    exact.exactAt = glm::ivec2(0, 0);
    renderer_.setPlans({exact, testing::planOf("warped", testing::homographyMap(kSize, kSize), kSize, kSize, 4, 3)});
    renderer_.upload(testing::wholeBatch(desktop_));
    renderer_.draw();
  }
  void SetUp() override {
    show();
    for (std::size_t i = 0; i < plain_.size(); ++i) plain_.at(i) = renderer_.readOutput(i);
  }
  void expectPlain(std::size_t output) {
    EXPECT_TRUE(testing::imageNear(renderer_.readOutput(output), plain_.at(output), 0, "overlay-gone"));
  }
  // How many pixels of an output are not as they are without anything over them, and the box around those.
  [[nodiscard]] std::pair<int, Box> changed(std::size_t output) {
    const Image8 now = renderer_.readOutput(output);
    int count = 0;
    Box box;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (std::equal(&now.at(x, y), &now.at(x, y) + 3, &plain_.at(output).at(x, y))) continue;
        ++count;
        box = enclose(box, {x, y, x + 1, y + 1});
      }
    }
    return {count, box};
  }

  WallRenderer renderer_{context_};
  Image8 desktop_ = testing::testDesktop(kSize);
  std::array<Image8, 2> plain_;
};

TEST_F(OverlayTest, APanelIsOnItsOutputAloneUntilTakenAway) {
  const std::vector<std::string> lines = {"total 12.5"};
  const Image8 panel = textPanel(lines, 2);
  renderer_.setPanel(1, panel);
  EXPECT_EQ(renderer_.draw(), std::vector<std::size_t>{1});
  expectPlain(0);
  const auto [count, box] = changed(1);
  EXPECT_GT(count, panel.width() * panel.height() * 8 / 10);
  EXPECT_TRUE((Box{16, 16, 16 + panel.width(), 16 + panel.height()}.contains(box)));
  // Drawn again below it, it is no darker.
  const Image8 before = renderer_.readOutput(1);
  renderer_.upload(testing::wholeBatch(desktop_));
  renderer_.draw();
  EXPECT_TRUE(testing::imageNear(renderer_.readOutput(1), before, 0, "panel-again"));
  renderer_.setPanel(1, {});
  renderer_.draw();
  expectPlain(1);
}

TEST_F(OverlayTest, APanelSurvivesNewPlans) {
  const std::vector<std::string> lines = {"queue"};
  const Image8 panel = textPanel(lines, 1);
  renderer_.setPanel(1, panel);
  renderer_.draw();
  const Image8 before = renderer_.readOutput(1);
  show();
  EXPECT_TRUE(testing::imageNear(renderer_.readOutput(1), before, 0, "panel-kept"));
  expectPlain(0);
}

TEST_F(OverlayTest, BordersSurroundWhatWasDrawnAndFade) {
  renderer_.showDamage(true);
  const Box damage{100, 60, 180, 120};
  renderer_.upload(testing::batchOf(desktop_, {damage}));
  EXPECT_EQ(renderer_.draw().size(), 2U);
  const auto [count, box] = changed(0);
  EXPECT_EQ(box, damage);
  EXPECT_NEAR(count, 2 * 2 * (80 + 56), 4);  // two pixels thick; one may be of the border's colour already
  int steps = 0;
  for (; renderer_.fading(); ++steps) {
    renderer_.fadeDamage();
    EXPECT_EQ(renderer_.draw().size(), 2U);
  }
  EXPECT_EQ(steps, FrameOverlay::kSteps);
  expectPlain(0);
  expectPlain(1);
  EXPECT_FALSE(renderer_.needsDraw());
}

TEST_F(OverlayTest, ManyBordersLeaveNothing) {
  renderer_.showDamage(true);
  for (int i = 0; i < 60; ++i) {
    const Box damage{i * 5, i * 3, i * 5 + 9, i * 3 + 7};
    renderer_.upload(testing::batchOf(desktop_, {damage}));
    renderer_.draw();
  }
  renderer_.showDamage(false);
  renderer_.draw();
  EXPECT_FALSE(renderer_.fading());
  expectPlain(0);
  expectPlain(1);
}

TEST(TextPanel, HasTheInkOfItsLetters) {
  const auto inkOf = [](const std::string& text) {
    const std::vector<std::string> lines = {text};
    const Image8 panel = textPanel(lines, 1);
    int ink = 0;
    for (int y = 0; y < panel.height(); ++y) {
      for (int x = 0; x < panel.width(); ++x) ink += panel.at(x, y, 0) == 255 ? 1 : 0;
    }
    return ink;
  };
  EXPECT_EQ(inkOf("?"), 0);
  EXPECT_EQ(inkOf("-"), 5);
  EXPECT_EQ(inkOf("1"), 10);
  EXPECT_EQ(inkOf("A"), inkOf("a"));
  EXPECT_EQ(inkOf("11.-"), 10 + 10 + 4 + 5);
  const std::vector<std::string> two = {"abc", "d"};
  EXPECT_EQ(textPanel(two, 3).size(), (Size{3 * (3 * 6 + 8), 3 * (2 * 10 + 8)}));
}

}  // namespace
}  // namespace pixelflex::viewer
