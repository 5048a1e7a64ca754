// What a day's work needs of keyboard, mouse and pointer, all the way from the wall's windows to the desktop.
#include <fstream>

#include "tests/e2e/view_desk_keys.h"
#include "tests/support/x_desk.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;

class EverydayTest : public DeskKeysTest {
 protected:
  void query(const std::vector<std::string>& command) { screen_.query(command); }
};

TEST_F(EverydayTest, AKeyThatIsHeldRepeatsUntilItIsLetGo) {
  start();
  watchDesktopKeys();
  waitForKeys();
  const auto pressed = [&] { return desktopHas("keysym 0x61, a"); };
  query({"xdotool", "keydown", "a"});
  EXPECT_TRUE(comesTrue([&] { return pressed() > 10; })) << log();
  query({"xdotool", "keyup", "a"});
  EXPECT_TRUE(comesTrue([&] { return keysDown(desktop_->x().display()) == 0; }));
  key("b");
  ASSERT_TRUE(comesTrue([&] { return desktopHas("keysym 0x62, b") == 2; })) << log();
  const std::size_t held = pressed();
  key("c");
  ASSERT_TRUE(comesTrue([&] { return desktopHas("keysym 0x63, c") == 2; })) << log();
  EXPECT_EQ(pressed(), held);
}

TEST_F(EverydayTest, DeadKeysAndAltGrWriteWhatIsOnThem) {
  query({"setxkbmap", "de"});
  start();
  watchDesktopKeys();
  waitForKeys();
  keys_.reset();
  const fs::path typed = folder_ / "typed";
  desktop_->x().start({"env", "LC_ALL=C.UTF-8", "xterm", "-u8", "-geometry", "190x12+0+0", "-e", "bash", "-c",
                       "read -r line; printf %s \"$line\" > " + typed.string()});
  desktop_->x().query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
  moveTo(260, 160);
  // The keys of a German keyboard by their numbers: ^ o, ´ e, AltGr with Q and E, ß, Return.
  query({"xdotool", "key", "--delay", "60", "49", "32", "21", "26"});
  query({"xdotool", "keydown", "108", "key", "--delay", "60", "24", "26", "keyup", "108"});
  query({"xdotool", "key", "--delay", "60", "20", "36"});
  ASSERT_TRUE(comesTrue([&] { return fs::exists(typed) && !textOf(typed).empty(); })) << log();
  EXPECT_EQ(textOf(typed), "ôé@€ß");
}

/// The desktop by VNC, and straight from its X server.
class ButtonsTest : public EverydayTest, public ::testing::WithParamInterface<bool> {};

TEST_P(ButtonsTest, WheelsAndSideButtonsReachTheDesktop) {
  makeWall(kAsOnTheWall);
  startViewerOf(GetParam() ? desktop_->unixAddress() : "x11:" + desktop_->x().display());
  waitForPicture(kAsOnTheWall[0]);
  const fs::path events = folder_ / "buttons";
  const Process xev({"stdbuf", "-oL", "xev", "-geometry", "1200x200+0+0", "-event", "button"},
                    {.environment = {"DISPLAY=" + desktop_->x().display()}, .log = events});
  desktop_->x().query({"xdotool", "search", "--sync", "--onlyvisible", "--name", "Event Tester"});
  const auto seen = [&](int button) {
    const std::string text = textOf(events);
    const std::string word = "button " + std::to_string(button) + ",";
    std::size_t count = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
  };
  moveTo(550, 190);
  ASSERT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(450, 100); })) << log();
  std::vector<int> buttons{2, 3, 4, 5, 6, 7};
  if (!GetParam()) buttons.insert(buttons.end(), {8, 9});  // Xvnc itself has seven
  for (const int button : buttons) {
    query({"xdotool", "click", std::to_string(button)});
    EXPECT_TRUE(comesTrue([&] { return seen(button) == 2; })) << button << "\n" << textOf(events);
  }
}

INSTANTIATE_TEST_SUITE_P(BothWays, ButtonsTest, ::testing::Bool(),
                         [](const auto& vnc) { return vnc.param ? "Vnc" : "X11"; });

TEST_F(EverydayTest, TheDesktopsBellRingsAtTheWall) {
  start();
  XBellWatch wall(screen_.display());
  ringBell(desktop_->x().display());
  EXPECT_TRUE(comesTrue([&] { return wall.rang(); })) << log();
}

class PointerPicture : public DeskKeysTest {
 protected:
  static constexpr int kReach = 24;  // around the point, pixels

  void SetUp() override {
    start();
    desktop_->x().query({"xsetroot", "-cursor_name", "crosshair"});
  }
  /// What is around a desktop pixel on the wall once the pointer is there.
  devices::Image8 around(glm::ivec2 point) {
    moveTo(kAsOnTheWall[0].x + point.x, kAsOnTheWall[0].y + point.y);
    EXPECT_TRUE(comesTrue([&] { return pointer() == point; })) << log();

    const glm::ivec2 corner = kAsOnTheWall[0] + point - glm::ivec2(kReach, kReach);
    const devices::Image8 screen = grabRoot(screen_.display());
    devices::Image8 part({2 * kReach, 2 * kReach}, 3);
    for (int y = 0; y < part.height(); ++y) {
      for (int x = 0; x < part.width(); ++x) {
        for (int c = 0; c < 3; ++c) part.at(x, y, c) = screen.at(corner.x + x, corner.y + y, c);
      }
    }
    return part;
  }
  [[nodiscard]] static int marked(const devices::Image8& picture) {
    int pixels = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) pixels += picture.at(x, y, 0) != 0x20 || picture.at(x, y, 1) != 0x40;
    }
    return pixels;
  }
};

TEST_F(PointerPicture, IsWholeAcrossTheBordersOfProjectorsAndTiles) {
  ASSERT_TRUE(comesTrue([&] { return marked(around({150, 100})) > 20; })) << log();
  const devices::Image8 whole = around({150, 100});
  // Between two projectors, and where one tile of the desktop's texture ends and the next begins.
  for (const int x : {300, 299, 305, 600, 900, 1024, 1020, 1028}) {
    EXPECT_TRUE(comesTrue([&] { return around({x, 100}) == whole; })) << x << ": " << marked(around({x, 100}));
  }
  EXPECT_TRUE(comesTrue([&] { return around({150, 100}) == whole; }));
}

TEST_F(PointerPicture, IsGoneWhileTheDesktopHidesIt) {
  ASSERT_TRUE(comesTrue([&] { return marked(around({300, 100})) > 20; })) << log();
  hidePointer(desktop_->x().display());
  EXPECT_TRUE(comesTrue([&] { return marked(around({300, 100})) == 0; })) << marked(around({300, 100}));
  EXPECT_EQ(marked(around({700, 60})), 0);
  desktop_->x().query({"xsetroot", "-cursor_name", "crosshair"});
  EXPECT_TRUE(comesTrue([&] { return marked(around({300, 100})) > 20; }));
}

}  // namespace
}  // namespace pixelflex::testing
