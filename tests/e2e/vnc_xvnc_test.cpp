#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::X11vncServer;
using pixelflex::testing::XServer;
using pixelflex::testing::XvncServer;
using ::testing::HasSubstr;

// Text, curves and edges on a patterned background, in windows that can be moved.
void fillDesktop(XServer& x) {
  x.query({"xsetroot", "-mod", "16", "12", "-fg", "steel blue", "-bg", "wheat"});
  x.start({"xterm", "-geometry", "80x24+30+40", "-e", "sh", "-c", "seq 1 2000; sleep 1000"});
  x.start({"xlogo", "-geometry", "200x200+600+300"});
  for (const char* name : {"xlogo", "xterm"})
    x.query({"xdotool", "search", "--sync", "--onlyvisible", "--class", name});
}

void moveLogo(XServer& x, int left, int top) {
  x.query({"xdotool", "search", "--class", "xlogo", "windowmove", "--sync", std::to_string(left), std::to_string(top)});
}

// A server that draws the pointer into the desktop may take a second to do so.
void expectStaysEqual(DesktopMirror& mirror, const std::string& display) {
  mirror.pumpFor(std::chrono::milliseconds(1300));
  EXPECT_TRUE(mirror.pumpUntilEqual(display, std::chrono::seconds(10))) << "is the pointer in the picture?";
}

// The desktop on the belt is the X server's own, at once and after a window and the pointer moved.
void expectBitForBit(XServer& x, const std::string& address) {
  fillDesktop(x);
  x.query({"xsetroot", "-cursor_name", "left_ptr"});
  DesktopMirror mirror(address);
  ASSERT_TRUE(mirror.pumpUntilEqual(x.display())) << mirror.summary();
  expectStaysEqual(mirror, x.display());
  moveLogo(x, 100, 420);
  ASSERT_TRUE(mirror.pumpUntilEqual(x.display())) << mirror.summary();
  mirror.session().sendPointer(150, 150, 0);  // onto the text, which has a pointer of its own
  expectStaysEqual(mirror, x.display());
  EXPECT_GT(mirror.last<CursorShape>().value_or(CursorShape{}).size.area(), 0) << "the shape comes beside the picture";
}

TEST(Xvnc, ShowsTheDesktopBitForBitOverAUnixSocket) {
  XvncServer server;
  expectBitForBit(server.x(), server.unixAddress());
}

TEST(Xvnc, ShowsALargeDesktopBitForBitOverTcp) {
  XvncServer server({.size = {3840, 2160}, .unixSocket = false, .tcp = true});
  expectBitForBit(server.x(), server.tcpAddress());
}

TEST(X11vnc, ShowsTheDesktopBitForBit) {
  X11vncServer server({1024, 768});
  expectBitForBit(server.x(), server.tcpAddress());
}

TEST(X11vnc, ShowsALargeDesktopBitForBit) {
  X11vncServer server({3840, 2160});
  expectBitForBit(server.x(), server.tcpAddress());
}

// x11vnc drops a client to whom it must send raw rows wider than this.
TEST(X11vnc, ShowsADesktopWiderThanItsBuffer) {
  X11vncServer server({9000, 300});
  server.x().query({"xsetroot", "-mod", "16", "12", "-fg", "steel blue", "-bg", "wheat"});
  DesktopMirror mirror(server.tcpAddress());
  EXPECT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mirror.summary();
}

TEST(Xvnc, IsNotTouchedByWhoOnlyViews) {
  XvncServer server;
  server.x().query({"xdotool", "mousemove", "700", "90"});
  SessionOptions options;
  options.server = parseServerAddress(server.unixAddress());
  options.viewOnly = true;
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > 0; })) << mirror.summary();
  mirror.pumpFor(std::chrono::milliseconds(300));
  EXPECT_THAT(server.x().query({"xdotool", "getmouselocation"}), HasSubstr("x:700 y:90 "));
}

TEST(X11vnc, KeepsThePointerOutOfThePictureWhoeverMovesIt) {
  X11vncServer server({1024, 768});
  fillDesktop(server.x());
  DesktopMirror mirror(server.tcpAddress());
  ASSERT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mirror.summary();
  server.x().query({"xdotool", "mousemove", "150", "150"});
  expectStaysEqual(mirror, server.x().display());
  EXPECT_THAT(server.x().query({"xdotool", "getmouselocation"}), HasSubstr("x:150 y:150 "));
}

TEST(Xvnc, FollowsAChangeOfSize) {
  XvncServer server;
  fillDesktop(server.x());
  DesktopMirror mirror(server.unixAddress());
  ASSERT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mirror.summary();
  for (const auto& [mode, size] : {std::pair("800x600", devices::Size{800, 600}), {"1920x1080", {1920, 1080}}}) {
    server.x().query({"xrandr", "-s", mode});
    ASSERT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mode << ": " << mirror.summary();
    EXPECT_EQ(mirror.desktop().size(), size);
    EXPECT_EQ(mirror.last<Resized>(), Resized{size});
  }
}

void expectInputArrives(XServer& x, const std::string& address) {
  const std::string typed = (x.folder() / "typed").string();
  x.start({"xterm", "-geometry", "80x24+0+0", "-e", "sh", "-c", "read line; echo \"$line\" > " + typed});
  x.query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
  DesktopMirror mirror(address);
  ASSERT_TRUE(mirror.pumpUntilEqual(x.display())) << mirror.summary();

  mirror.session().sendPointer(123, 234, 0);
  EXPECT_TRUE(mirror.pumpUntil([&x] { return x.query({"xdotool", "getmouselocation"}).starts_with("x:123 y:234 "); }));
  mirror.session().sendPointer(123, 234, 1);
  mirror.session().sendPointer(123, 234, 0);
  for (const std::uint32_t key : {0x57u, 0x61u, 0x6cu, 0x6cu, 0x37u, 0xff0du}) {  // Wall7 and Return
    const bool shifted = key == 0x57u;
    if (shifted) mirror.session().sendKey(0xffe1, true);
    mirror.session().sendKey(key, true);
    mirror.session().sendKey(key, false);
    if (shifted) mirror.session().sendKey(0xffe1, false);
  }
  const auto line = [&typed] {
    std::string text;
    std::getline(std::ifstream(typed) >> std::ws, text);
    return text;
  };
  EXPECT_TRUE(mirror.pumpUntil([&line] { return line() == "Wall7"; })) << "typed: " << line();
}

TEST(Xvnc, ReceivesPointerAndKeys) {
  XvncServer server;
  expectInputArrives(server.x(), server.unixAddress());
}

TEST(X11vnc, ReceivesPointerAndKeys) {
  X11vncServer server({1024, 768});
  expectInputArrives(server.x(), server.tcpAddress());
}

Closed closedWithPassword(const XvncServer& server, std::optional<Secret> password) {
  SessionOptions options;
  options.server = parseServerAddress(server.unixAddress());
  options.password = std::move(password);
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>() || mirror.updates() > 0; })) << mirror.summary();
  return mirror.last<Closed>().value_or(Closed{CloseKind::kLost, "connected"});
}

TEST(Xvnc, ChecksThePassword) {
  const XvncServer server({.password = "sesame"});
  EXPECT_EQ(closedWithPassword(server, "sesame").message, "connected");
  const Closed missing = closedWithPassword(server, std::nullopt);
  EXPECT_EQ(missing.kind, CloseKind::kPasswordNeeded);
  EXPECT_THAT(missing.message, HasSubstr("asks for a password"));
  const Closed wrong = closedWithPassword(server, "wrong");
  EXPECT_EQ(wrong.kind, CloseKind::kAuthentication);
  EXPECT_THAT(wrong.message, HasSubstr("refused the password"));
}

TEST(Xvnc, MayBeKilled) {
  XvncServer server;
  DesktopMirror mirror(server.unixAddress());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > 0; })) << mirror.summary();
  server.x().process().signal(SIGKILL);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); }));
  EXPECT_EQ(mirror.last<Closed>().value_or(Closed{CloseKind::kProtocol, {}}).kind, CloseKind::kLost);
  mirror.session().sendKey('a', true);
}

TEST(Xvnc, LeavesTheProcessorAloneWhenIdle) {
  XvncServer server;
  fillDesktop(server.x());
  DesktopMirror mirror(server.unixAddress());
  ASSERT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mirror.summary();
  mirror.pumpFor(std::chrono::milliseconds(300));
  const std::uint64_t batches = mirror.batches();
  const std::clock_t before = std::clock();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 0.02);
  mirror.pumpFor(std::chrono::milliseconds(0));
  EXPECT_EQ(mirror.batches(), batches) << "nothing changed, nothing may travel";
}

long peakKilobytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

struct Counted {
  std::int64_t pixels = 0;
  std::int64_t light = 0;  // white ones
  bool complete = false;
};

// Looks at the first update without keeping it.
Counted countFirstUpdate(FrameBelt& belt, devices::Size desktop) {
  Counted counted;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!counted.complete && std::chrono::steady_clock::now() < deadline) {
    Batch* batch = belt.take();
    if (batch == nullptr) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    EXPECT_EQ(batch->desktop, desktop);
    counted.pixels += static_cast<std::int64_t>(batch->pixels.size() / 4);
    for (std::size_t i = 0; i < batch->pixels.size(); i += 4)
      counted.light += batch->pixels[i] == std::byte{255} ? 1 : 0;
    counted.complete = batch->completesUpdate;
    belt.release(batch);
  }
  return counted;
}

TEST(Xvnc, OpensTheLargestWallInBoundedMemory) {
  XvncServer server({.size = {16384, 8192}});
  server.x().start({"xlogo", "-geometry", "500x500+15000+7000"});
  server.x().query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xlogo"});
  SessionOptions options;
  options.server = parseServerAddress(server.unixAddress());
  FrameBelt belt(nullptr);
  const Session session(options, belt, nullptr);
  const Counted counted = countFirstUpdate(belt, {16384, 8192});
  EXPECT_TRUE(counted.complete);
  EXPECT_EQ(counted.pixels, std::int64_t{16384} * 8192);
  EXPECT_GT(counted.light, 100 * 500) << "the logo is black and white on black";
  EXPECT_LT(counted.light, 500 * 500);
  EXPECT_LT(peakKilobytes(), 1000 * 1024) << "one frame buffer of 512 MiB and three batches of 16 MiB, never two";
}

}  // namespace
}  // namespace pixelflex::viewer
