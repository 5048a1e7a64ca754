// What keys and pointer mean to the viewer itself: the shortcuts, the grab, finding the pointer.
#include "tests/e2e/view_desk_keys.h"
#include "tests/support/x_shortcut.h"

namespace pixelflex::testing {
namespace {

class GesturesTest : public DeskKeysTest {
 protected:
  /// The colour of the ring around the pointer.
  [[nodiscard]] int amber() const {
    const devices::Image8 picture = grabRoot(screen_.display());
    int pixels = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        pixels += picture.at(x, y, 0) == 255 && picture.at(x, y, 1) == 176 && picture.at(x, y, 2) == 0;
      }
    }
    return pixels;
  }
};

TEST_F(GesturesTest, TwoTapsOfCtrlShowWhereThePointerIs) {
  start();
  moveTo(400, 180);  // the ring lies over two screens
  ASSERT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(300, 90); })) << log();
  EXPECT_EQ(amber(), 0);
  ASSERT_TRUE(comesTrue([&] {
    screen_.query({"xdotool", "key", "--delay", "30", "Control_L", "Control_L"});
    return amber() > 200;
  }));
  EXPECT_TRUE(comesTrue([&] { return amber() == 0; }));
}

TEST_F(GesturesTest, ShakingShowsWhereThePointerIs) {
  start();
  moveTo(400, 180);
  ASSERT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(300, 90); })) << log();
  EXPECT_EQ(amber(), 0);
  ASSERT_TRUE(comesTrue([&] {
    std::vector<std::string> shake{"xdotool"};
    for (int i = 0; i < 8; ++i) {
      shake.insert(shake.end(), {"mousemove", i % 2 == 0 ? "600" : "400", "180", "sleep", "0.05"});
    }
    screen_.query(shake);
    return amber() > 200;
  }));
  EXPECT_TRUE(comesTrue([&] { return amber() == 0; }));
}

TEST_F(GesturesTest, ThePointerStaysInTheRegionThatIsShown) {
  start({"--pointer", "desktop", "--region", "300,40,600x100"});
  const auto moveBy = [&](int x, int y) {
    screen_.query({"xdotool", "mousemove_relative", "--", std::to_string(x), std::to_string(y)});
  };
  ASSERT_TRUE(comesTrue([&] { return moveBy(-40, -40), pointer() == glm::ivec2(300, 40); })) << log();
  ASSERT_TRUE(comesTrue([&] { return moveBy(40, 40), pointer() == glm::ivec2(899, 139); })) << log();
}

TEST_F(GesturesTest, TheEscapeKeysWorkOnALayoutWithoutLatinLetters) {
  screen_.query({"setxkbmap", "ru"});
  start();
  moveTo(250, 150);
  ASSERT_TRUE(comesTrue([&] {
    key("ctrl+alt+24");  // the keycode of Q
    return !viewer_->running();
  })) << log();
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(1)), 0);
}

TEST_F(GesturesTest, AShortcutShowsTheStatisticsAndTakesThemAway) {
  start();
  watchDesktopKeys();
  waitForKeys();
  moveTo(850, 150);  // away from the first screen
  paintDesktop("#204060");
  desktop_->x().query({"xdotool", "search", "--name", "Event Tester", "windowunmap"});
  const auto written = [&] {
    const devices::Image8 picture = grabRoot(screen_.display());
    int pixels = 0;
    for (int y = 90; y < 90 + kHeight; ++y) {
      for (int x = 100; x < 100 + kWidth; ++x) pixels += picture.at(x, y, 0) != 0x20 || picture.at(x, y, 1) != 0x40;
    }
    return pixels;
  };
  ASSERT_TRUE(comesTrue([&] { return written() == 0; })) << log();
  key("ctrl+alt+s");
  EXPECT_TRUE(comesTrue([&] { return written() > 500; })) << log();
  key("ctrl+alt+s");
  EXPECT_TRUE(comesTrue([&] { return written() == 0; })) << log();
  EXPECT_EQ(desktopHas("keysym 0x73, s"), 0U) << "the shortcut is not the desktop's";
}

TEST_F(GesturesTest, TheGrabTakesTheKeysOfOthersUntilItIsLetGo) {
  XShortcut shortcut(screen_.display());
  start({"--grab"});
  watchDesktopKeys();
  waitForKeys();
  ASSERT_TRUE(comesTrue([&] {
    key("F9");
    return desktopHas("keysym 0xffc6, F9") > 0;
  })) << log();
  EXPECT_FALSE(shortcut.used());
  key("ctrl+alt+g");
  ASSERT_TRUE(comesTrue([&] { return key("F9"), shortcut.used(); }));
  key("ctrl+alt+g");
  const std::size_t before = desktopHas("keysym 0xffc6, F9");
  EXPECT_TRUE(comesTrue([&] { return key("F9"), desktopHas("keysym 0xffc6, F9") > before; }));
  EXPECT_EQ(desktopHas("keysym 0x67, g"), 0U) << "the shortcut is not the desktop's";
}

TEST_F(GesturesTest, WithoutTheGrabTheKeysOfOthersAreTheirs) {
  XShortcut shortcut(screen_.display());
  start();
  watchDesktopKeys();
  waitForKeys();
  ASSERT_TRUE(comesTrue([&] { return key("F9"), shortcut.used(); }));
  waitForKeys();
  EXPECT_EQ(desktopHas("keysym 0xffc6, F9"), 0U);
}

}  // namespace
}  // namespace pixelflex::testing
