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

TEST_F(LocalView, IsChosenForXvncWhenAskedTo) {
  const auto x = startServer();
  x->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  const Output over = shoot("unix:" + socket());
  EXPECT_THAT(over.text, Not(HasSubstr(kDirectly)));
  const Output directly = shoot("unix:" + socket(), {"--source", "auto"});
  ASSERT_EQ(directly.status, 0) << directly.text;
  EXPECT_THAT(directly.text, HasSubstr(kDirectly));
  expectExact(*x);
  const Output secure = shoot("unix:" + socket(), {"--source", "auto", "--require", "vnc"});
  EXPECT_THAT(secure.text, Not(HasSubstr(kDirectly))) << "what must be secured goes over VNC";
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
