#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <iostream>
#include <thread>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using devices::Image8;
using devices::Size;

/// A few windows with text, lines and curves, everywhere on the desktop; returns once they are drawn.
void openWindows(XServer& x, Size desktop) {
  x.query({"xsetroot", "-mod", "16", "16", "-fg", "#336699", "-bg", "#204060"});
  const auto at = [&](double fx, double fy) {
    return "+" + std::to_string(int(desktop.width * fx)) + "+" + std::to_string(int(desktop.height * fy));
  };
  x.start({"xlogo", "-geometry", "300x300" + at(0.1, 0.1)});
  x.start({"xcalc", "-geometry", "260x330" + at(0.45, 0.4)});
  x.start({"xlogo", "-geometry", "400x300" + at(0.6, 0.55)});
  std::this_thread::sleep_for(1500ms);
}

/// The wall's screens put side by side, as its desktop is.
Image8 compose(const fs::path& folder, int columns, int rows, Size screen) {
  Image8 whole({columns * screen.width, rows * screen.height}, 3);
  for (int i = 0; i < columns * rows; ++i) {
    const Image8 part = devices::readPng8(folder / ("p" + std::to_string(i + 1) + ".png"));
    EXPECT_EQ(part.size(), screen);
    const int left = (i % columns) * screen.width;
    const int top = (i / columns) * screen.height;
    for (int y = 0; y < screen.height; ++y) {
      std::ranges::copy(part.row(y), whole.row(top + y).subspan(static_cast<std::size_t>(left) * 3).begin());
    }
  }
  return whole;
}

struct Flat {
  std::string text;
  int columns, rows;
  Size screen;
};

class ExactTest : public ::testing::Test {
 protected:
  void makeWall(const Flat& flat) {
    const Output made = runProgram("new", {wall().string(), "--flat", flat.text});
    ASSERT_EQ(made.status, 0) << made.text;
  }
  void expectExact(XServer& x, const std::string& address, const Flat& flat) {
    const fs::path shot = folder_ / "shot";
    fs::remove_all(shot);
    const Output run = runProgram("view", {wall().string(), address, "--headless", "--screenshot", shot.string()});
    ASSERT_EQ(run.status, 0) << run.text;
    const Image8 expected = grabRoot(x.display());
    // Equal or not, without gigantic failure messages.
    EXPECT_TRUE(devices::readPng8(shot / "desktop.png") == expected);
    EXPECT_TRUE(compose(shot, flat.columns, flat.rows, flat.screen) == expected);
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  const TemporaryFolder folder_;
};

const Flat kOne{"1024x768", 1, 1, {1024, 768}};
const Flat kFour{"2x2:1920x1080", 2, 2, {1920, 1080}};

TEST_F(ExactTest, XvncOverItsUnixSocket) {
  XvncServer server({.size = {1024, 768}});
  openWindows(server.x(), {1024, 768});
  makeWall(kOne);
  expectExact(server.x(), server.unixAddress(), kOne);
}

TEST_F(ExactTest, XvncOverTcpAcrossTileBorders) {
  XvncServer server({.size = {3840, 2160}, .unixSocket = false, .tcp = true});
  openWindows(server.x(), {3840, 2160});
  makeWall(kFour);
  expectExact(server.x(), server.tcpAddress(), kFour);
}

TEST_F(ExactTest, X11vncOnXvfb) {
  X11vncServer server({1024, 768});
  openWindows(server.x(), {1024, 768});
  makeWall(kOne);
  expectExact(server.x(), server.tcpAddress(), kOne);
}

TEST_F(ExactTest, X11vncOnXvfbAcrossTileBorders) {
  X11vncServer server({3840, 2160});
  openWindows(server.x(), {3840, 2160});
  makeWall(kFour);
  expectExact(server.x(), server.tcpAddress(), kFour);
}

TEST_F(ExactTest, AfterAWindowMoved) {
  XvncServer server({.size = {3840, 2160}});
  openWindows(server.x(), {3840, 2160});
  makeWall(kFour);
  // The viewer is connected while the window moves: what it has is the sum of partial updates.
  const fs::path shot = folder_ / "shot";
  Process viewer({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(), server.unixAddress(),
                  "--headless", "--screenshot", shot.string(), "--settle", "3000"});
  std::this_thread::sleep_for(1500ms);
  const std::string window = server.x().query({"xdotool", "search", "--class", "xcalc"});
  for (const auto* position : {"1700", "1900", "980"}) {
    server.x().query({"xdotool", "windowmove", window.substr(0, window.find('\n')), position, "990"});
    std::this_thread::sleep_for(300ms);
  }
  ASSERT_EQ(viewer.wait(60s), 0);
  const Image8 expected = grabRoot(server.x().display());
  EXPECT_TRUE(devices::readPng8(shot / "desktop.png") == expected);
  EXPECT_TRUE(compose(shot, 2, 2, {1920, 1080}) == expected);
}

TEST_F(ExactTest, AHugeDesktopOpensWithinThreeGigabytes) {
  XvncServer server({.size = {16384, 8192}});
  server.x().query({"xsetroot", "-solid", "#123456"});
  makeWall({"16384x8192", 1, 1, {16384, 8192}});
  const fs::path shot = folder_ / "shot";
  const Output run =
      runProgram("view", {wall().string(), server.unixAddress(), "--headless", "--screenshot", shot.string()});
  ASSERT_EQ(run.status, 0) << run.text;
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  std::cout << "viewer's peak: " << usage.ru_maxrss / 1024 << " MiB\n";
  EXPECT_LT(usage.ru_maxrss, 3L * 1024 * 1024);  // KiB
  const Image8 desktop = devices::readPng8(shot / "desktop.png");
  ASSERT_EQ(desktop.size(), (Size{16384, 8192}));
  EXPECT_EQ(desktop.at(16383, 8191, 0), 0x12);
  EXPECT_EQ(desktop.at(8000, 4000, 2), 0x56);
}

}  // namespace
}  // namespace pixelflex::testing
