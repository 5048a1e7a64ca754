// What hand and tracker make of a model's view.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "viewer/programs/model_navigation.h"
#include "viewer/programs/model_options.h"
#include "viewer/programs/model_tracker.h"

namespace pixelflex::viewer {
namespace {

class NavigationTest : public ::testing::Test {
 protected:
  ModelView view() {
    ModelView now{.window = {{4000, 2000}}};
    changed_ = navigation_.apply(now);
    return now;
  }
  void key(std::uint32_t keysym, char letter = 0) {
    navigation_.key({keysym, true, letter});
    navigation_.key({keysym, false, letter});
  }
  ModelNavigation navigation_{{.yaw = 10, .pitch = 5}, false, false, std::nullopt, 1000};
  bool changed_ = false;
};

TEST_F(NavigationTest, DragsTurnAndMove) {
  EXPECT_EQ(view().pose.yaw, 10);
  EXPECT_TRUE(changed_);
  navigation_.pointer({0, 0});
  navigation_.pointer({300, 0});
  (void)view();
  EXPECT_FALSE(changed_);
  navigation_.button(1, true);
  navigation_.pointer({800, 250});
  EXPECT_DOUBLE_EQ(view().pose.yaw, 10 + 90);
  EXPECT_DOUBLE_EQ(view().pose.pitch, 5 + 45);
  navigation_.button(1, false);
  navigation_.button(3, true);
  navigation_.pointer({1300, 750});
  EXPECT_EQ(view().pose.shift, glm::dvec3(0.5, -0.5, 0));
  navigation_.button(3, false);
  navigation_.pointer({0, 0});
  EXPECT_EQ(view().pose.shift, glm::dvec3(0.5, -0.5, 0));
}

TEST_F(NavigationTest, KeysFlySwitchAndGoBack) {
  key('w');
  EXPECT_GT(view().pose.shift.z, 0);
  navigation_.scroll(2);
  EXPECT_NEAR(view().pose.zoom, 1.21, 1e-9);
  key('f');
  EXPECT_EQ(view().pose.zoom, 1);
  EXPECT_EQ(view().pose.yaw, 10);
  key('l');
  key('x');
  EXPECT_TRUE(view().wireframe && view().axes);
  key(0xFF53);
  key(0xFF50);
  EXPECT_EQ(view().pose, (ModelPose{.yaw = 10, .pitch = 5}));
  key('c');
  ASSERT_TRUE(view().cut);
  EXPECT_EQ(*view().cut, glm::dvec4(0, 0, -1, 0));
  key(']');
  EXPECT_NEAR(view().cut->w, 100, 1e-9);
  key('c');
  EXPECT_FALSE(view().cut);
}

TEST_F(NavigationTest, EscapeAndTheUsualShortcutEnd) {
  key('q', 'q');
  EXPECT_FALSE(navigation_.quit());
  navigation_.key({0xFFE3, true});
  navigation_.key({0xFFE9, true});
  navigation_.key({'q', true, 'q'});
  EXPECT_TRUE(navigation_.quit());
}

TEST(ModelTracker, TakesTheLastWholeLine) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ModelTracker tracker(ends[0]);
  const auto say = [&](const std::string& text) {
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  };
  EXPECT_FALSE(tracker.read());
  say("1 2 3\nnonsense\n4 5 6\n7 8");
  EXPECT_EQ(tracker.read(), glm::dvec3(4, 5, 6));
  say(" 9\n1 1 -5\n");
  EXPECT_EQ(tracker.read(), glm::dvec3(7, 8, 9));
  ::close(ends[1]);
  EXPECT_FALSE(tracker.read());
  EXPECT_TRUE(tracker.ended());
  ::close(ends[0]);
}

TEST(ModelOptions, NumbersAreCounted) {
  EXPECT_EQ(parseNumbers("--eye", "1,-2.5,3e2", 3, 3), (std::vector<double>{1, -2.5, 300}));
  EXPECT_THROW((void)parseNumbers("--eye", "1,2", 3, 3), std::invalid_argument);
  EXPECT_THROW((void)parseNumbers("--eye", "1,2,", 2, 3), std::logic_error);
  EXPECT_THROW((void)parseNumbers("--eye", "1,nan", 1, 3), std::invalid_argument);
  EXPECT_THROW((void)parseNumbers("--eye", "", 1, 3), std::invalid_argument);
}

// The window: what lies in its plane keeps its place wherever the eye is; what lies behind moves with it.
TEST(ModelView, TheWallIsAWindow) {
  const WallWindow window{{400, 200}};
  const auto seen = [&](glm::dvec3 eye, glm::dvec3 point) {
    const glm::dvec4 clip = desktopFromWindow(window, eye, {0, 0, 0}, 500) * glm::dvec4(point, 1);
    return glm::dvec3(clip) / clip.w;
  };
  for (const glm::dvec3 eye : {glm::dvec3(0, 0, 500), glm::dvec3(150, -40, 300), glm::dvec3(900, 0, 900)}) {
    const glm::dvec3 corner = seen(eye, {200, 100, 0});
    EXPECT_NEAR(corner.x, 1, 1e-9);
    EXPECT_NEAR(corner.y, -1, 1e-9);  // rows go downwards
  }
  EXPECT_GT(seen({100, 0, 500}, {0, 0, -300}).x, 0.05);
  EXPECT_LT(seen({0, 0, 500}, {0, 0, 100}).z, seen({0, 0, 500}, {0, 0, -100}).z);
}

}  // namespace
}  // namespace pixelflex::viewer
