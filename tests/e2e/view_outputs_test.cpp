// Monitors that go and come back, and several X displays.
#include <unistd.h>

#include <csignal>
#include <optional>

#include "tests/e2e/view_screens.h"

namespace pixelflex::testing {
namespace {

class OutputsTest : public ScreensTest {
 protected:
  void onMonitors() {
    calib::Wall flat = calib::loadWall(wall());
    for (auto& projector : flat.projectors) {
      projector.output = {.kind = calib::OutputKind::kMonitor, .monitor = "m-" + projector.name};
    }
    calib::saveWall(wall(), flat);
  }
  void onDisplay(std::size_t projector, const std::string& display) {
    calib::Wall flat = calib::loadWall(wall());
    flat.projectors[projector].output.display = display;
    calib::saveWall(wall(), flat);
  }
  void plugIn(const std::string& name, int x) {
    screen_.query({"xrandr", "--setmonitor", name, "300/80x200/60+" + std::to_string(x) + "+100", "none"});
    tell();
  }
  void unplug(const std::string& name) {
    screen_.query({"xrandr", "--delmonitor", name});
    tell();
  }
  /// Xvfb tells of other changes than of monitors that were only named.
  void tell() { screen_.query({"xrandr", "--fb", "1400x700", "--dpi", std::to_string(++dpi_)}); }

  int dpi_ = 90;
};

TEST_F(OutputsTest, AMonitorThatGoesComesBackAndTheOtherGoesOn) {
  makeWall({{0, 0}, {0, 0}});
  onMonitors();
  plugIn("m-p1", 100);
  startViewer();
  ASSERT_TRUE(comesTrue([&] { return logHolds("monitor m-p2 is not there: projector p2 is dark"); })) << log();
  paintDesktop("#206040");
  ASSERT_TRUE(comesTrue([&] { return shows({110, 110}, {0x20, 0x60, 0x40}); })) << log();
  plugIn("m-p2", 700);
  ASSERT_TRUE(comesTrue([&] { return shows({710, 110}, {0x20, 0x60, 0x40}); })) << log();
  EXPECT_TRUE(logHolds("monitor m-p2 is there: projector p2 is shown"));
  unplug("m-p1");
  ASSERT_TRUE(comesTrue([&] { return logHolds("monitor m-p1 is not there: projector p1 is dark"); })) << log();
  paintDesktop("#604020");
  EXPECT_TRUE(comesTrue([&] { return shows({710, 110}, {0x60, 0x40, 0x20}); })) << log();
  plugIn("m-p1", 400);
  EXPECT_TRUE(comesTrue([&] { return shows({410, 110}, {0x60, 0x40, 0x20}); })) << "where it is now\n" << log();
  EXPECT_TRUE(viewer_->running());
}

TEST_F(OutputsTest, ProjectorsOfSeveralXServersShowOneDesktopTogether) {
  // Nobody else's number, although it is not taken all the time.
  const std::string display = ":" + std::to_string(2000 + ::getpid() % 30'000);
  std::optional<XServer> second;
  const auto startSecond = [&] {
    second.emplace([&](const TemporaryFolder&) {
      return std::vector<std::string>{"Xvfb", display, "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset"};
    });
  };
  startSecond();
  makeWall({{100, 90}, {200, 50}});
  onDisplay(1, display);
  startViewer();
  paintDesktop("#204060");
  ASSERT_TRUE(comesTrue([&] { return shows({110, 100}, {0x20, 0x40, 0x60}); })) << log();
  ASSERT_TRUE(comesTrue([&] { return showsOn(display, {210, 60}, {0x20, 0x40, 0x60}); })) << log();
  second->query({"xdotool", "mousemove", "250", "80"});
  EXPECT_TRUE(comesTrue([&] { return pointer() == glm::ivec2(350, 30); })) << log();
  second.reset();
  EXPECT_TRUE(comesTrue([&] { return logHolds("display " + display + " is dark, the others go on"); })) << log();
  paintDesktop("#604020");
  EXPECT_TRUE(comesTrue([&] { return shows({110, 100}, {0x60, 0x40, 0x20}); })) << log();
  startSecond();
  EXPECT_TRUE(comesTrue([&] { return showsOn(display, {210, 60}, {0x60, 0x40, 0x20}); })) << log();
  EXPECT_TRUE(comesTrue([&] { return logHolds("display " + display + " is shown again"); })) << log();
  viewer_->signal(SIGTERM);
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 0) << log();
}

TEST_F(OutputsTest, ProjectorsOfSeveralDisplaysEndWhenNoneOfThemCanShowAnything) {
  makeWall({{100, 90}, {200, 50}});
  onDisplay(0, ":" + std::to_string(2000 + ::getpid() % 30'000));
  onDisplay(1, ":" + std::to_string(40'000 + ::getpid() % 30'000));
  startViewer();
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 1) << log();
}

TEST_F(OutputsTest, ProjectorsOfTwoScreensOfAnXServerEndTogether) {
  XServer screens([](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen",    "0",         "800x600x24", "-screen",
                                    "1",    "800x600x24", "-nolisten", "tcp",        "-noreset"};
  });
  makeWall({{100, 90}, {200, 50}});
  onDisplay(0, screens.display());
  onDisplay(1, screens.display() + ".1");
  const std::string stats = (folder_ / "stats.json").string();
  startViewer({"--stats-json", stats});
  paintDesktop("#204060");
  ASSERT_TRUE(comesTrue([&] { return showsOn(screens.display(), {110, 100}, {0x20, 0x40, 0x60}); })) << log();
  ASSERT_TRUE(comesTrue([&] { return showsOn(screens.display() + ".1", {210, 60}, {0x20, 0x40, 0x60}); })) << log();
  screens.query({"xdotool", "mousemove", "150", "150"});
  ASSERT_TRUE(comesTrue([&] {
    screens.query({"xdotool", "key", "ctrl+alt+q"});
    return !viewer_->running();
  })) << log();
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(1)), 0) << log();
  for (const std::string& display : {screens.display(), screens.display() + ".1"}) {
    EXPECT_NE(textOf(stats).find("{\"display\":\"" + display + "\",\"first_picture_s\":"), std::string::npos);
    EXPECT_NE(textOf(stats).find("{\"display\":\"" + display + "\",\"seconds\":"), std::string::npos) << textOf(stats);
  }
}

TEST_F(OutputsTest, SaysWhichMonitorsThereAreWhenNoneIsTheWalls) {
  makeWall({{0, 0}});
  onMonitors();
  startViewer();
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 1);
  EXPECT_TRUE(logHolds("none of the projectors' monitors is there; there are: screen")) << log();
}

}  // namespace
}  // namespace pixelflex::testing
