// Windows on a real X server: where they are, what they show, and what reaches them from pointer and keyboard.
#include "devices/display/window.h"

#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <X11/keysym.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/display/monitors.h"
#include "devices/display/window_projector.h"
#include "tests/gl/x_server.h"

namespace pixelflex::devices {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Key = std::pair<std::uint32_t, bool>;

constexpr auto kPatience = 20s;

/// Red, green, blue and white quarters, from the top-left clockwise: red, green, white, blue.
Image8 quarters(Size size) {
  Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool right = x >= size.width / 2;
      const bool low = y >= size.height / 2;
      image.at(x, y, 0) = right == low ? 255 : 0;
      image.at(x, y, 1) = right ? 255 : 0;
      image.at(x, y, 2) = low ? 255 : 0;
    }
  }
  return image;
}

GlTexture textureOf(const Image8& image) {
  auto texture = GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture.get(), 1, GL_RGBA8, image.width(), image.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.get(), 0, 0, 0, image.width(), image.height(), GL_RGB, GL_UNSIGNED_BYTE,
                      image.samples().data());
  glFinish();
  return texture;
}

class WindowTest : public ::testing::Test {
 protected:
  WindowTest() : server_(800, 600), loop_(server_.display()) {}

  /// Runs the loop until the condition holds; false when it does not for a long time.
  bool eventually(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      loop_.wait(20ms);
    }
    return true;
  }

  /// Sends input as a person would; the server keeps it until the loop runs.
  static void xdotool(const std::string& arguments) {
    EXPECT_EQ(std::system(("xdotool " + arguments).c_str()), 0) << arguments;
  }

  testing::XServer server_;
  EventLoop loop_;
};

TEST_F(WindowTest, ABorderlessWindowIsWhereItWasAskedForAndShowsRowZeroOnTop) {
  Window window(loop_, {.title = "p1", .size = {200, 120}, .at = glm::ivec2(150, 90), .borderless = true});
  EXPECT_EQ(window.size(), (Size{200, 120}));
  GlDebugLog log;
  const auto picture = textureOf(quarters({200, 120}));
  ASSERT_TRUE(eventually([&] {
    window.present(picture.get(), {200, 120});
    return server_.colourAt(150, 90) == 0xFF0000;
  }));
  EXPECT_EQ(window.position(), glm::ivec2(150, 90));
  EXPECT_EQ(server_.colourAt(349, 90), 0x00FF00U);
  EXPECT_EQ(server_.colourAt(150, 209), 0x0000FFU);
  EXPECT_EQ(server_.colourAt(349, 209), 0xFFFFFFU);
  EXPECT_EQ(server_.colourAt(149, 90), 0U);
  EXPECT_EQ(server_.colourAt(350, 209), 0U);
  EXPECT_TRUE(log.take().empty());
}

// On a software driver, as here; others swap the whole window.
TEST_F(WindowTest, OnlyThePartsOfAPictureThatChangedAreShownAnew) {
  Window window(loop_, {.title = "p1", .size = {200, 120}, .at = glm::ivec2(150, 90), .borderless = true});
  GlDebugLog log;
  const auto before = textureOf(quarters({200, 120}));
  ASSERT_TRUE(eventually([&] {
    window.present(before.get(), {200, 120});
    return server_.colourAt(150, 90) == 0xFF0000;
  }));
  Image8 grey({200, 120}, 3);
  std::ranges::fill(grey.samples(), std::uint8_t{0x40});
  grey.at(10, 20, 0) = 0x60;
  grey.at(39, 24, 0) = 0x70;
  const auto after = textureOf(grey);
  const std::vector<Part> parts{{{10, 20}, {30, 5}}, {{199, 119}, {1, 1}}};
  window.present(after.get(), {200, 120}, parts);
  ASSERT_TRUE(eventually([&] { return server_.colourAt(349, 209) == 0x404040; }));
  EXPECT_EQ(server_.colourAt(160, 110), 0x604040U);
  EXPECT_EQ(server_.colourAt(189, 114), 0x704040U);
  for (const auto& [x, y] : {std::pair{159, 110}, {160, 109}, {190, 114}, {189, 115}, {150, 90}}) {
    EXPECT_EQ(server_.colourAt(x, y), 0xFF0000U) << x << ", " << y;
  }
  EXPECT_EQ(server_.colourAt(348, 209), 0xFFFFFFU);
  const std::vector<Part> most{{{0, 0}, {200, 100}}};
  window.present(after.get(), {200, 120}, most);
  EXPECT_TRUE(eventually([&] { return server_.colourAt(348, 209) == 0x404040; }));
  EXPECT_TRUE(log.take().empty());
}

TEST_F(WindowTest, TenBitsAreNotToBeHadEverywhere) {
  Window window(loop_, {.title = "p1", .size = {64, 64}, .bitsPerColour = 10});
  EXPECT_EQ(window.bitsPerColour(), 8);
}

TEST(DeepWindowTest, TenBitsReachTheScreen) {
  testing::XServer server(640, 480, 30);
  EventLoop loop(server.display());
  Window window(loop,
                {.title = "p1", .size = {64, 64}, .at = glm::ivec2(0, 0), .borderless = true, .bitsPerColour = 10});
  EXPECT_EQ(window.bitsPerColour(), 10);
  auto texture = GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture.get(), 1, GL_RGB10_A2, 64, 64);
  const std::vector<std::uint32_t> pixels(std::size_t{64} * 64, 513U | 2U << 10 | 1022U << 20);  // red lowest
  glTextureSubImage2D(texture.get(), 0, 0, 0, 64, 64, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, pixels.data());
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (server.colourAt(30, 30) == 0 && std::chrono::steady_clock::now() < end) {
    window.present(texture.get(), {64, 64});
    loop.wait(20ms);
  }
  EXPECT_EQ(server.colourAt(30, 30), 513U << 20 | 2U << 10 | 1022U);
}

TEST_F(WindowTest, AWindowShowsTexturesOfTheOneItSharesWith) {
  Window renderer(loop_, {.title = "hidden", .size = {16, 16}, .visible = false});
  const auto picture = textureOf(quarters({64, 64}));
  {
    Window window(loop_, {.title = "p", .size = {128, 128}, .at = glm::ivec2(10, 20), .borderless = true}, &renderer);
    GlDebugLog log;
    EXPECT_TRUE(eventually([&] {
      window.present(picture.get(), {64, 64});
      return server_.colourAt(20, 30) == 0xFF0000 && server_.colourAt(130, 140) == 0xFFFFFF;
    }));
    EXPECT_TRUE(log.take().empty());
  }
  renderer.makeCurrent();
  EXPECT_EQ(glIsTexture(picture.get()), GL_TRUE);
}

TEST_F(WindowTest, PointerButtonsAndWheelArrive) {
  Window window(loop_, {.title = "p", .size = {300, 200}, .at = glm::ivec2(100, 50), .borderless = true});
  glm::dvec2 pointer(-1, -1);
  std::vector<std::pair<int, bool>> buttons;
  glm::dvec2 wheel(0, 0);
  window.setHandlers({.pointer = [&](glm::dvec2 p) { pointer = p; },
                      .button = [&](int button, bool pressed) { buttons.emplace_back(button, pressed); },
                      .scroll = [&](glm::dvec2 steps) { wheel += steps; }});
  loop_.wait(100ms);
  xdotool("mousemove 137 91");
  EXPECT_TRUE(eventually([&] { return pointer == glm::dvec2(37, 41); })) << pointer.x << ", " << pointer.y;
  xdotool("click 1 click 2 click 3 click 8 click 4 click 4 click 5 click 4");
  EXPECT_TRUE(eventually([&] { return buttons.size() >= 8 && wheel.y == 2; }));
  EXPECT_THAT(buttons, ElementsAre(std::pair(1, true), std::pair(1, false), std::pair(2, true), std::pair(2, false),
                                   std::pair(3, true), std::pair(3, false), std::pair(8, true), std::pair(8, false)));
}

TEST_F(WindowTest, APointerThatReturnsToWhereItLeftIsTold) {
  Window window(loop_, {.title = "p", .size = {300, 200}, .at = glm::ivec2(100, 50), .borderless = true});
  std::vector<glm::dvec2> pointer;
  window.setHandlers({.pointer = [&](glm::dvec2 p) { pointer.push_back(p); }});
  loop_.wait(100ms);
  xdotool("mousemove 137 91");
  EXPECT_TRUE(eventually([&] { return !pointer.empty() && pointer.back() == glm::dvec2(37, 41); }));
  xdotool("mousemove 20 20");
  loop_.wait(100ms);
  pointer.clear();
  xdotool("mousemove 137 91");
  EXPECT_TRUE(eventually([&] { return !pointer.empty(); }));
  EXPECT_THAT(pointer, ::testing::Each(glm::dvec2(37, 41)));
}

TEST_F(WindowTest, KeysArriveAsKeysyms) {
  Window window(loop_, {.title = "p", .size = {300, 200}, .at = glm::ivec2(100, 50), .borderless = true});
  std::vector<Key> keys;
  window.setHandlers({.key = [&](const KeyStroke& stroke) { keys.emplace_back(stroke.keysym, stroke.pressed); }});
  loop_.wait(200ms);
  xdotool("key a");
  EXPECT_TRUE(eventually([&] { return keys.size() == 2; }));
  EXPECT_THAT(keys, ElementsAre(Key(XK_a, true), Key(XK_a, false)));
  keys.clear();
  xdotool("keydown shift keydown a keyup shift keyup a");
  EXPECT_TRUE(eventually([&] { return keys.size() == 4; }));
  EXPECT_THAT(keys, ElementsAre(Key(XK_Shift_L, true), Key(XK_A, true), Key(XK_Shift_L, false), Key(XK_A, false)));
  keys.clear();
  xdotool("key Return key F5 key Left key comma key ctrl+c key KP_Enter");
  EXPECT_TRUE(eventually([&] { return keys.size() == 14; }));
  std::vector<std::uint32_t> presses;
  for (const auto& [keysym, pressed] : keys) {
    if (pressed) presses.push_back(keysym);
  }
  EXPECT_THAT(presses, ElementsAre(XK_Return, XK_F5, XK_Left, XK_comma, XK_Control_L, XK_c, XK_KP_Enter));
}

TEST_F(WindowTest, TextTypedArrivesWholeAlsoAfterTheLayoutChanged) {
  Window window(loop_, {.title = "p", .size = {300, 200}, .at = glm::ivec2(100, 50), .borderless = true});
  std::string text;
  window.setHandlers({.key = [&](const KeyStroke& stroke) {
    const auto keysym = stroke.keysym;
    if (stroke.pressed && keysym >= XK_space && keysym <= XK_ydiaeresis) text += static_cast<char>(keysym);
  }});
  loop_.wait(200ms);
  xdotool("type --delay 20 'Pixel_Flex {8x}'");
  EXPECT_TRUE(eventually([&] { return text == "Pixel_Flex {8x}"; })) << text;
  text.clear();
  ASSERT_EQ(std::system("xmodmap -e 'keysym q = eacute'"), 0);
  xdotool("key eacute");
  EXPECT_TRUE(eventually([&] { return text == "\xE9"; }));
}

TEST_F(WindowTest, KeysHeldAreReleasedWhenTheKeyboardGoesElsewhere) {
  Window window(loop_, {.title = "p", .size = {200, 100}, .at = glm::ivec2(0, 0), .borderless = true});
  std::vector<Key> keys;
  window.setHandlers({.key = [&](const KeyStroke& stroke) { keys.emplace_back(stroke.keysym, stroke.pressed); }});
  loop_.wait(200ms);
  xdotool("keydown ctrl");
  EXPECT_TRUE(eventually([&] { return keys.size() == 1; }));
  const Window other(loop_, {.title = "q", .size = {200, 100}, .at = glm::ivec2(300, 0), .borderless = true});
  EXPECT_TRUE(eventually([&] { return keys.size() == 2; }));
  EXPECT_THAT(keys, ElementsAre(Key(XK_Control_L, true), Key(XK_Control_L, false)));
  xdotool("keyup ctrl");
}

TEST_F(WindowTest, ShortcutsHaveTheirLetterInEveryLayout) {
  Window window(loop_, {.title = "p", .size = {200, 100}, .at = glm::ivec2(0, 0), .borderless = true});
  std::vector<std::pair<std::uint32_t, char>> keys;
  window.setHandlers({.key = [&](const KeyStroke& stroke) {
    if (stroke.pressed && stroke.keysym != XK_Control_L) keys.emplace_back(stroke.keysym, stroke.letter);
  }});
  const auto strokeIn = [&](const std::string& layout, const std::string& keycode) {
    EXPECT_EQ(std::system(("setxkbmap " + layout).c_str()), 0);
    loop_.wait(50ms);
    keys.clear();
    xdotool("keydown ctrl key " + keycode + " keyup ctrl");
    EXPECT_TRUE(eventually([&] { return !keys.empty(); }));
    return keys.front();
  };
  // The keys are Q and A, G, and 1 of a US keyboard.
  EXPECT_EQ(strokeIn("us", "24"), std::pair(std::uint32_t{XK_q}, 'q'));
  EXPECT_EQ(strokeIn("fr", "24"), std::pair(std::uint32_t{XK_a}, 'a'));
  EXPECT_EQ(strokeIn("ru,us", "24"), std::pair(std::uint32_t{XK_Cyrillic_shorti}, 'q'));
  EXPECT_EQ(strokeIn("ru", "24"), std::pair(std::uint32_t{XK_Cyrillic_shorti}, 'q'));
  EXPECT_EQ(strokeIn("gr", "42"), std::pair(std::uint32_t{XK_Greek_gamma}, 'g'));
  EXPECT_EQ(strokeIn("ru", "10"), std::pair(std::uint32_t{XK_1}, '\0'));
}

TEST_F(WindowTest, AGrabbedKeyboardIsNobodyElsesAndWhatIsHeldIsReleasedAtItsEnd) {
  Window window(loop_, {.title = "p", .size = {200, 100}, .at = glm::ivec2(0, 0), .borderless = true});
  Window other(loop_, {.title = "q", .size = {200, 100}, .at = glm::ivec2(300, 0), .borderless = true});
  std::vector<Key> keys;
  std::vector<Key> others;
  window.setHandlers({.key = [&](const KeyStroke& stroke) { keys.emplace_back(stroke.keysym, stroke.pressed); }});
  other.setHandlers({.key = [&](const KeyStroke& stroke) { others.emplace_back(stroke.keysym, stroke.pressed); }});
  loop_.wait(200ms);
  xdotool("key a");
  EXPECT_TRUE(eventually([&] { return others.size() == 2; })) << "the one shown last has the keyboard";
  ASSERT_TRUE(window.grabKeyboard());
  EXPECT_FALSE(other.grabKeyboard());
  xdotool("key b keydown shift");
  EXPECT_TRUE(eventually([&] { return keys.size() == 3; }));
  window.releaseKeyboard();
  EXPECT_THAT(keys, ElementsAre(Key(XK_b, true), Key(XK_b, false), Key(XK_Shift_L, true), Key(XK_Shift_L, false)));
  xdotool("keyup shift key c");
  EXPECT_TRUE(eventually([&] { return others.size() == 4; }));
  EXPECT_EQ(keys.size(), 4U);
}

TEST_F(WindowTest, CloseAndRedrawAreTold) {
  Window window(loop_, {.title = "room", .size = {300, 200}, .at = glm::ivec2(100, 50)});
  int closes = 0;
  int redraws = 0;
  window.setHandlers({.close = [&] { ++closes; }, .redraw = [&] { ++redraws; }});
  EXPECT_TRUE(eventually([&] { return redraws > 0; }));
  ASSERT_TRUE(server_.askToClose("room"));
  EXPECT_TRUE(eventually([&] { return closes == 1; }));
}

TEST_F(WindowTest, WhatAHandlerThrowsComesOutOfTheLoop) {
  Window window(loop_, {.title = "room", .size = {300, 200}, .at = glm::ivec2(100, 50)});
  window.setHandlers({.close = [] { throw std::runtime_error("from the handler"); }});
  loop_.wait(100ms);
  ASSERT_TRUE(server_.askToClose("room"));
  EXPECT_THROW(eventually([] { return false; }), std::runtime_error);
}

TEST_F(WindowTest, WakeEndsAWaitFromAnotherThread) {
  std::thread waker([] {
    std::this_thread::sleep_for(50ms);
    EventLoop::wake();
  });
  const auto begin = std::chrono::steady_clock::now();
  loop_.wait(60s);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s);
  waker.join();
}

TEST_F(WindowTest, AProjectorWindowShowsItsFrames) {
  WindowProjector projector("p1", loop_, {160, 120}, {40, 30});
  EXPECT_EQ(projector.name(), "p1");
  EXPECT_EQ(projector.resolution(), (Size{160, 120}));
  const auto shows = [&](std::uint32_t colour) {
    return eventually([&] { return server_.colourAt(41, 31) == colour; });
  };
  projector.show(quarters({160, 120}));
  EXPECT_TRUE(shows(0xFF0000));
  EXPECT_EQ(server_.colourAt(199, 149), 0xFFFFFFU);
  Image8 grey({160, 120}, 1);
  for (auto& sample : grey.samples()) sample = 0x80;
  projector.show(grey);
  EXPECT_TRUE(shows(0x808080));
  projector.blank();
  EXPECT_TRUE(shows(0));
  EXPECT_THROW(projector.show(Image8({160, 121}, 3)), std::invalid_argument);
}

TEST_F(WindowTest, MonitorsAreListed) {
  const auto monitors = listMonitors(loop_);
  ASSERT_EQ(monitors.size(), 1U);
  EXPECT_EQ(monitors[0].size, (Size{800, 600}));
  EXPECT_EQ(findMonitor(loop_, monitors[0].name), monitors[0]);
  try {
    (void)findMonitor(loop_, "HDMI-9");
    FAIL() << "found";
  } catch (const DisplayError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'HDMI-9'"));
    EXPECT_THAT(error.what(), HasSubstr(monitors[0].name));
  }
}

TEST(EventLoopTest, SaysThatTheServerIsGone) {
  std::optional<testing::XServer> server(std::in_place, 640, 480);
  const std::string display = server->display();
  EventLoop loop(display);
  const Window window(loop, {.title = "p", .size = {64, 64}, .at = glm::ivec2(0, 0), .borderless = true});
  loop.wait(100ms);
  server.reset();
  try {
    for (int i = 0; i < 10; ++i) loop.wait(kPatience);
    FAIL() << "went on";
  } catch (const DisplayError& error) {
    EXPECT_THAT(error.what(), HasSubstr(display));
  }
}

TEST(EventLoopTest, SaysThatThereIsNoDisplay) {
  try {
    const EventLoop loop(":4711");
    FAIL() << "opened";
  } catch (const DisplayError& error) {
    EXPECT_THAT(error.what(), HasSubstr(":4711"));
    EXPECT_THAT(error.what(), HasSubstr("--headless"));
  }
}

}  // namespace
}  // namespace pixelflex::devices
