#include <gmock/gmock.h>

#include <csignal>

#include "devices/image/png_file.h"
#include "tests/e2e/view_lost.h"
#include "viewer/x11/same_desktop.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;
using viewer::displayBehind;
using viewer::parseServerAddress;

constexpr const char* kDirectly = "shown directly";

TEST(DisplayBehind, IsKnownOfXvncOnly) {
  XvncServer xvnc({.size = {320, 240}, .tcp = true});
  const viewer::XDisplay display = viewer::parseXDisplay(xvnc.x().display());
  EXPECT_EQ(displayBehind(parseServerAddress(xvnc.unixAddress())), display);
  EXPECT_EQ(displayBehind(parseServerAddress(xvnc.tcpAddress())), display);
  X11vncServer x11vnc({320, 240});
  EXPECT_EQ(displayBehind(parseServerAddress(x11vnc.tcpAddress())), std::nullopt);
  EXPECT_EQ(displayBehind(parseServerAddress("unix:/no/such/socket")), std::nullopt);
  EXPECT_EQ(displayBehind(parseServerAddress("wall.example::" + xvnc.tcpAddress().substr(11))), std::nullopt);
}

class LocalView : public LostTest {
 protected:
  void expectExact(const XServer& x) const {
    const devices::Image8 expected = grabRoot(x.display());
    EXPECT_TRUE(devices::readPng8(folder_ / "shot/desktop.png") == expected);
    EXPECT_TRUE(wallPicture() == expected);
  }
  [[nodiscard]] Output shoot(const std::string& server, std::vector<std::string> more = {}) const {
    std::vector<std::string> words{wall().string(), server, "--headless", "--screenshot", (folder_ / "shot").string()};
    words.insert(words.end(), more.begin(), more.end());
    return runProgram("view", words);
  }
};

TEST_F(LocalView, OfAnXDisplayIsExact) {
  const auto x = startServer();
  x->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  const Output shot = shoot("x11:" + x->display());
  ASSERT_EQ(shot.status, 0) << shot.text;
  expectExact(*x);
}

TEST_F(LocalView, DoesNotShowTheDisplayThatItsWindowsAreOn) {
  const auto x = startServer();
  const Output refused =
      run({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(), "x11:" + x->display()},
          {"DISPLAY=" + x->display()});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.text, HasSubstr("which they show"));
}

TEST_F(LocalView, IsChosenForXvncUnlessSomethingIsWishedThatOnlyVncHas) {
  const auto x = startServer();
  x->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  const Output directly = shoot("unix:" + socket());
  ASSERT_EQ(directly.status, 0) << directly.text;
  EXPECT_THAT(directly.text, HasSubstr(kDirectly));
  expectExact(*x);
  const std::vector<std::vector<std::string>> wishes = {
      {"--source", "vnc"}, {"--require", "vnc"}, {"--user", "somebody"}, {"--resize", "--screens", "projectors"}};
  for (const auto& wish : wishes) {
    EXPECT_THAT(shoot("unix:" + socket(), wish).text, Not(HasSubstr(kDirectly))) << wish.front();
  }
}

TEST_F(LocalView, GoesOverVncWhenTheServerMustBeAskedForAnotherSize) {
  const auto x = startServer("800x600");
  const Output shot = shoot("unix:" + socket(), {"--resize"});
  ASSERT_EQ(shot.status, 0) << shot.text;
  EXPECT_THAT(shot.text, Not(HasSubstr("scaled")));
  EXPECT_EQ(devices::readPng8(folder_ / "shot/desktop.png").size(), (devices::Size{640, 240}));
  expectExact(*x);
}

TEST_F(LocalView, NeedsTheServersCookieAndElseGoesOverVnc) {
  const std::string name = "MIT-MAGIC-COOKIE-1";
  const std::string head{'\xff', '\xff', 0, 0, 0, 0, 0, static_cast<char>(name.size())};  // any host and display
  const std::string cookies = (folder_ / "cookies").string();
  writeText(cookies, head + name + std::string{0, 16} + "sixteen letters.");
  const XServer x([&](const TemporaryFolder&) {
    return std::vector<std::string>{"Xtigervnc", "-geometry",      "640x240",  "-depth", "24",
                                    "-auth",     cookies,          "-rfbport", "-1",     "-rfbunixpath",
                                    socket(),    "-SecurityTypes", "None"};
  });
  const Output over = shoot("unix:" + socket());
  EXPECT_EQ(over.status, 0);
  EXPECT_THAT(over.text, Not(HasSubstr("pixelflex-view:"))) << "and says nothing";
  const std::string viewer = std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view";
  const Output directly =
      run({viewer, wall().string(), "unix:" + socket(), "--headless", "--screenshot", (folder_ / "shot").string()},
          {"PIXELFLEX_XAUTHORITY=" + cookies});
  EXPECT_EQ(directly.status, 0);
  EXPECT_THAT(directly.text, HasSubstr(kDirectly));
}

TEST_F(LocalView, GoesOnOverVncWhenItsServerCameBackAsAnotherDisplay) {
  auto server = startServer();
  const auto viewer = startViewer({"--source", "auto", "--retry", "lost", "--stats", "--screenshot",
                                   (folder_ / "shot").string(), "--settle", "3000"});
  waitFor("stats:", 1);
  server->process().signal(SIGKILL);
  server->process().wait(20s);
  waitFor(kLost, 1);
  server = startServer();
  server->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  waitFor(kBack, 1);
  ASSERT_EQ(viewer->wait(60s), 0) << log();
  expectExact(*server);
}

TEST_F(LocalView, IsBackWithItsDisplay) {
  auto x = startServer();
  const std::string display = x->display();
  const auto viewer = startViewer({"--retry", "lost", "--stats"}, "x11:" + display);
  waitFor("stats:", 1);
  x->process().signal(SIGKILL);
  x->process().wait(20s);
  waitFor(kLost, 1);
  x = std::make_unique<XServer>([&](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", display, "-screen", "0", "640x240x24", "-nolisten", "tcp"};
  });
  waitFor(kBack, 1);
  viewer->signal(SIGTERM);
  EXPECT_EQ(viewer->wait(20s), 0) << log();
}

}  // namespace
}  // namespace pixelflex::testing
