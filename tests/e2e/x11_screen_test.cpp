#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>

#include "tests/e2e/x11_mirror.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using viewer::Closed;
using viewer::CloseKind;
using viewer::Connected;
using viewer::CursorMoved;
using viewer::CursorShape;
using viewer::Lost;
using viewer::Resized;

std::ptrdiff_t connections(const DesktopMirror& mirror) {
  return std::ranges::count_if(mirror.events(), [](const auto& e) { return std::holds_alternative<Connected>(e); });
}

void paint(const XServer& x) {
  x.query({"xsetroot", "-mod", "16", "16", "-fg", "#336699", "-bg", "#204060"});
}

TEST(LocalScreen, IsTheXServersOwnBitForBit) {
  for (const devices::Size size : {devices::Size{1024, 768}, devices::Size{3840, 2160}, devices::Size{1, 1}}) {
    const auto x = startXvfb(size);
    paint(*x);
    x->start({"xlogo", "-geometry", "300x300+50+40"});
    const auto mirror = mirrorOf(x->display());
    EXPECT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
    EXPECT_EQ(mirror->desktop().size(), size);
  }
}

TEST(LocalScreen, FollowsWindowsThatMove) {
  const auto x = startXvfb({1024, 768});
  paint(*x);
  x->start({"xlogo", "-geometry", "300x300+50+40"});
  const auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  const std::string window = x->query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xlogo"});
  const std::string id = window.substr(0, window.find('\n'));
  for (const char* at : {"400", "130", "0"}) {
    x->query({"xdotool", "windowmove", "--sync", id, at, "201"});
    EXPECT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  }
}

TEST(LocalScreen, OfXvncIsTheSame) {
  XvncServer server({.size = {1280, 720}});
  paint(server.x());
  const auto mirror = mirrorOf(server.x().display());
  EXPECT_TRUE(mirror->pumpUntilEqual(server.x().display())) << mirror->summary();
}

TEST(LocalScreen, MayBeAsWideAsAnXServersCan) {
  const auto x = startXvfb({32767, 96});
  paint(*x);
  x->start({"xlogo", "-geometry", "90x90+32600+3"});
  const auto mirror = mirrorOf(x->display());
  EXPECT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  EXPECT_EQ(mirror->desktop().width(), 32767);
}

TEST(LocalScreen, CostsWhatHasChanged) {
  const auto x = startXvfb({3840, 2160});
  paint(*x);
  const auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  ASSERT_TRUE(mirror->pumpUntilStill()) << mirror->summary();
  const std::uint64_t before = mirror->bytes();
  x->start({"xlogo", "-geometry", "100x80+1000+1000", "-bw", "0"});
  ASSERT_TRUE(mirror->pumpUntil([&] { return mirror->bytes() > before; })) << mirror->summary();
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  EXPECT_TRUE(mirror->pumpUntilStill()) << "a still desktop costs nothing; " << mirror->summary();
  // The window's ground and the logo's strokes are damage of their own wherever the server is slow to draw them.
  EXPECT_LE(mirror->bytes() - before, 16 * 4 * 100 * 80u);
}

TEST(LocalScreen, FollowsResizes) {
  XvncServer server({.size = {800, 600}});
  paint(server.x());
  const auto mirror = mirrorOf(server.x().display());
  ASSERT_TRUE(mirror->pumpUntilEqual(server.x().display())) << mirror->summary();
  for (const devices::Size size : {devices::Size{1024, 768}, devices::Size{640, 480}}) {
    const std::string text = std::to_string(size.width) + "x" + std::to_string(size.height);
    server.x().query({"xrandr", "--output", "VNC-0", "--mode", text});
    ASSERT_TRUE(mirror->pumpUntil([&] { return mirror->desktop().size() == size; })) << mirror->summary();
    EXPECT_TRUE(mirror->pumpUntilEqual(server.x().display())) << mirror->summary();
    EXPECT_EQ(mirror->last<Resized>(), Resized{size});
  }
}

TEST(LocalScreen, TellsThePointersPictureAndPlace) {
  const auto x = startXvfb({800, 600});
  const auto mirror = mirrorOf(x->display());
  x->query({"xdotool", "mousemove", "123", "234"});
  ASSERT_TRUE(mirror->pumpUntil([&] { return mirror->last<CursorMoved>() == CursorMoved{123, 234}; }));
  const auto hasShape = [&] { return mirror->last<CursorShape>().value_or(CursorShape{}).size.area() > 0; };
  // A server that has just started shows no pointer until both have changed.
  ASSERT_TRUE(mirror->pumpUntil([&] {
    x->query({"xsetroot", "-cursor_name", mirror->events().size() % 2 == 0 ? "crosshair" : "arrow"});
    x->query({"xdotool", "mousemove_relative", "1", "1"});
    return hasShape();
  })) << mirror->summary();
  const CursorShape crosshair = *mirror->last<CursorShape>();
  EXPECT_EQ(crosshair.rgba.size(), static_cast<std::size_t>(crosshair.size.area()) * 4);
  x->query({"xsetroot", "-cursor_name", "watch"});
  EXPECT_TRUE(mirror->pumpUntil([&] { return *mirror->last<CursorShape>() != crosshair; }));
}

TEST(LocalScreen, IsBackWhenItsServerIs) {
  auto x = startXvfb({640, 480});
  const std::string display = x->display();
  DesktopMirror mirror(makeLocal({.display = viewer::parseXDisplay(display), .retry = viewer::Retry::kLost}));
  ASSERT_TRUE(mirror.pumpUntilEqual(display)) << mirror.summary();
  for (int i = 1; i <= 3; ++i) {
    x->process().signal(SIGKILL);
    x->process().wait(20s);
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Lost>().has_value(); })) << mirror.summary();
    EXPECT_EQ(mirror.last<Lost>()->kind, CloseKind::kLost);
    x = startXvfb({800, 600}, {display});
    paint(*x);
    ASSERT_TRUE(mirror.pumpUntil([&] { return connections(mirror) == i + 1; })) << mirror.summary();
    EXPECT_TRUE(mirror.pumpUntilEqual(display)) << mirror.summary();
  }
}

TEST(LocalScreen, OfAServerThatStallsIsLostAndBack) {
  const auto x = startXvfb({640, 480});
  DesktopMirror mirror(
      makeLocal({.display = viewer::parseXDisplay(x->display()), .patience = 1200ms, .retry = viewer::Retry::kLost}));
  ASSERT_TRUE(mirror.pumpUntilEqual(x->display())) << mirror.summary();
  x->process().signal(SIGSTOP);
  const bool lost = mirror.pumpUntil([&] { return mirror.last<Lost>().has_value(); });
  x->process().signal(SIGCONT);
  ASSERT_TRUE(lost) << mirror.summary();
  EXPECT_THAT(mirror.last<Lost>()->message, HasSubstr("does not answer"));
  ASSERT_TRUE(mirror.pumpUntil([&] { return connections(mirror) == 2; })) << mirror.summary();
  paint(*x);
  EXPECT_TRUE(mirror.pumpUntilEqual(x->display())) << mirror.summary();
}

TEST(LocalScreen, OfAStalledServerCanBeLeft) {
  const auto x = startXvfb({640, 480});
  auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  x->process().signal(SIGSTOP);
  const auto begin = std::chrono::steady_clock::now();
  mirror.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s);
  x->process().signal(SIGCONT);
}

/// How a session ends that cannot begin.
Closed endOf(const std::string& display) {
  const auto mirror = mirrorOf(display);
  mirror->pumpUntil([&] { return mirror->last<Closed>().has_value(); });
  return mirror->last<Closed>().value_or(Closed{CloseKind::kLost, mirror->summary()});
}

TEST(LocalScreen, SaysWhyThereIsNone) {
  const Closed nobody = endOf(":4711");
  EXPECT_EQ(nobody.kind, CloseKind::kUnreachable);
  EXPECT_THAT(nobody.message, HasSubstr("no X server answers at display :4711"));
  const auto x = startXvfb({640, 480});
  const Closed noScreen = endOf(x->display() + ".3");
  EXPECT_EQ(noScreen.kind, CloseKind::kUnsupported);
  EXPECT_THAT(noScreen.message, HasSubstr("has no screen 3"));
  const XServer coarse([](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "640x480x16", "-nolisten", "tcp", "-noreset"};
  });
  EXPECT_THAT(endOf(coarse.display()).message, HasSubstr("depth 16"));
}

TEST(LocalScreen, OfAServerWithACookieNeedsIt) {
  const XServer x([](const TemporaryFolder& folder) {
    const std::string file = (folder / "authority").string();
    const Output made = run({"xauth", "-f", file, "add", ":0", ".", "00112233445566778899aabbccddeeff"});
    EXPECT_EQ(made.status, 0) << made.text;
    return std::vector<std::string>{"Xvfb", "-screen", "0", "64x48x24", "-nolisten", "tcp", "-auth", file};
  });
  const Closed refused = endOf(x.display());
  EXPECT_EQ(refused.kind, CloseKind::kAuthentication);
  EXPECT_THAT(refused.message, HasSubstr("does not let us in"));
}

}  // namespace
}  // namespace pixelflex::testing
