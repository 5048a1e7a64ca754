// Working on a wall: typing, drawing, the control window.
#include <algorithm>
#include <fstream>

#include "tests/e2e/view_desk_keys.h"
#include "tests/support/paint_client.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

const std::vector<glm::ivec2> kApart{{0, 450}, {1050, 20}, {20, 20}, {700, 300}};

class DeskTest : public ScreensTest {
 protected:
  void moveBy(int dx) { screen_.query({"xdotool", "mousemove_relative", "--", std::to_string(dx), "0"}); }

  /// One unbroken line across the whole desktop, along one row.
  void expectOneLine(const PaintClient& paint, int from, int to) {
    const auto strokes = paint.strokes();
    ASSERT_EQ(strokes.size(), 1U);
    const auto& stroke = strokes.front();
    EXPECT_TRUE(std::ranges::is_sorted(stroke, {}, &glm::ivec2::x)) << "the pointer jumped back";
    for (const auto& point : stroke) EXPECT_EQ(point.y, stroke.front().y);
    EXPECT_LE(stroke.front().x, from);
    EXPECT_GE(stroke.back().x, to);
    const devices::Image8 picture = grabRoot(desktop_->x().display());
    for (int x = stroke.front().x; x < stroke.back().x; ++x) {
      ASSERT_EQ(picture.at(x, stroke.front().y, 0), 0) << "the line is broken at " << x;
    }
  }
};

TEST_F(DeskTest, ADragAcrossFourScreensThatLieApartIsOneLine) {
  makeWall(kApart);
  startViewer();
  waitForPicture(kApart[0]);
  const PaintClient paint(desktop_->x().display());
  // To the left edge first, wherever it was.
  ASSERT_TRUE(comesTrue([&] { return moveBy(-40), pointer().x == 0; })) << log();
  screen_.query({"xdotool", "mousedown", "1"});
  ASSERT_TRUE(comesTrue([&] { return paint.strokes().size() == 1; }));
  ASSERT_TRUE(comesTrue([&] { return moveBy(40), pointer().x == 1199; }));
  screen_.query({"xdotool", "mouseup", "1"});
  ASSERT_TRUE(comesTrue([&] { return paint.strokes().front().back().x == 1199; }));
  expectOneLine(paint, 0, 1199);
}

TEST_F(DeskTest, ADragAcrossFourScreensSideBySideIsOneLine) {
  makeWall(kAsOnTheWall);
  startViewer();
  waitForPicture(kAsOnTheWall[0]);
  const PaintClient paint(desktop_->x().display());
  screen_.query({"xdotool", "mousemove", "110", "150"});
  ASSERT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(10, 60); })) << log();
  screen_.query({"xdotool", "mousedown", "1"});
  ASSERT_TRUE(comesTrue([&] { return paint.strokes().size() == 1; }));
  for (int x = 130; x <= 1290; x += 20) screen_.query({"xdotool", "mousemove", std::to_string(x), "150"});
  ASSERT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(1190, 60); }));
  screen_.query({"xdotool", "mouseup", "1"});
  expectOneLine(paint, 10, 1190);
}

TEST_F(DeskTest, TextOfAnotherLayoutArrivesLetterForLetter) {
  screen_.query({"setxkbmap", "de"});
  makeWall(kAsOnTheWall);
  const fs::path typed = folder_ / "typed";
  desktop_->x().start({"env", "LC_ALL=C.UTF-8", "xterm", "-u8", "-geometry", "100x10+0+0", "-e", "bash", "-c",
                       "read -r line; printf %s \"$line\" > " + typed.string()});
  desktop_->x().query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
  startViewer();
  ASSERT_TRUE(comesTrue([&] {
    screen_.query({"xdotool", "mousemove", "150", "150"});
    return pointer() == glm::ivec2(50, 60);
  })) << log();
  screen_.query({"xdotool", "type", "--delay", "60", "to be removed"});
  screen_.query({"xdotool", "key", "--delay", "60", "ctrl+u"});
  const std::string text = "Größe äöüß €5 {[z|y]} \\ @q ~ < > # '^2' Ende";
  screen_.query({"xdotool", "type", "--delay", "60", text});
  screen_.query({"xdotool", "key", "Return"});
  ASSERT_TRUE(comesTrue([&] { return fs::exists(typed) && !textOf(typed).empty(); })) << log();
  EXPECT_EQ(textOf(typed), text);
}

TEST_F(DeskTest, TheControlWindowPointsWithoutTheWall) {
  makeWall({{0, 450}, {1050, 450}});
  startViewer({"--control"});
  std::string id;
  ASSERT_TRUE(comesTrue([&] {
    id = answer(screen_, {"xdotool", "search", "--onlyvisible", "--name", "PixelFlex: the desktop"});
    return !id.empty();
  })) << log();
  id = id.substr(0, id.find('\n'));
  ASSERT_TRUE(comesTrue([&] {
    screen_.query({"xdotool", "mousemove", "--window", id, "450", "60"});  // as large as the desktop
    return pointer() == glm::ivec2(450, 60);
  })) << log();
  paintDesktop("#a0b0c0");
  const std::string at = screen_.query({"xdotool", "getwindowgeometry", "--shell", id});
  const auto number = [&](const std::string& key) { return std::stoi(at.substr(at.find(key) + key.size())); };
  EXPECT_TRUE(comesTrue([&] { return shows({number("X=") + 550, number("Y=") + 150}, {0xa0, 0xb0, 0xc0}); }));
}

}  // namespace
}  // namespace pixelflex::testing
