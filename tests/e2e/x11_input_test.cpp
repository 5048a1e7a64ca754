#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "tests/e2e/programs.h"
#include "tests/e2e/x11_mirror.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using viewer::Bell;
using viewer::Clipboard;
namespace fs = std::filesystem;

constexpr std::uint32_t kReturn = 0xff0d;
constexpr std::uint32_t kShift = 0xffe1;
constexpr std::uint32_t kControl = 0xffe3;
constexpr std::uint32_t kUnicode = 0x01000000;

/// Keysyms as a keyboard's that has each letter on a key of its own.
std::vector<std::uint32_t> keysymsOf(std::u32string_view text) {
  std::vector<std::uint32_t> keysyms;
  for (const char32_t letter : text) keysyms.push_back(letter < 0x100 ? letter : kUnicode + letter);
  return keysyms;
}

void tap(viewer::DesktopSource& desktop, std::uint32_t keysym) {
  desktop.sendKey(keysym, true);
  desktop.sendKey(keysym, false);
}

std::string textOfSize(std::size_t bytes) {
  std::string text = "äöß€ ";
  while (text.size() < bytes) text += static_cast<char>('a' + text.size() % 26);
  return text;
}

class LocalInput : public ::testing::Test {
 protected:
  /// A terminal that writes its first line into a file; it has the focus when this returns.
  void openTerminal(XServer& x) const {
    x.start({"xterm", "-u8", "-geometry", "60x10+0+0", "-e", "bash", "-c",
             "read line; echo \"$line\" > " + (folder_ / "part").string() + "; mv " + (folder_ / "part").string() +
                 " " + typed().string()});
    x.query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
  }
  [[nodiscard]] fs::path typed() const { return folder_ / "typed"; }
  /// What came out of the terminal.
  [[nodiscard]] std::string line(DesktopMirror& mirror) const {
    mirror.pumpUntil([&] { return fs::exists(typed()); });
    return textOf(typed());
  }
  /// Starts a server, a terminal and a session that points into it.
  void start(std::unique_ptr<XServer> x) {
    x_ = std::move(x);
    openTerminal(*x_);
    mirror_ = mirrorOf(x_->display());
    ASSERT_TRUE(mirror_->pumpUntilEqual(x_->display())) << mirror_->summary();
    mirror_->session().sendPointer(100, 50, 0);
  }
  void type(std::u32string_view text) {
    for (const std::uint32_t keysym : keysymsOf(text)) tap(mirror_->session(), keysym);
    tap(mirror_->session(), kReturn);
  }
  const TemporaryFolder folder_;
  std::unique_ptr<XServer> x_;
  std::unique_ptr<DesktopMirror> mirror_;
};

TEST_F(LocalInput, TypedTextArrivesLetterForLetter) {
  start(startXvfb({800, 600}));
  type(U"Wall of 8, (ok)! {x}@~ äöüÄÖÜß€ żółć λ ЖЩ");
  EXPECT_EQ(line(*mirror_), "Wall of 8, (ok)! {x}@~ äöüÄÖÜß€ żółć λ ЖЩ\n");
}

TEST_F(LocalInput, TypedTextArrivesWhateverIsHeldAndWhateverTheLayout) {
  start(startXvfb({800, 600}));
  x_->query({"setxkbmap", "de"});
  viewer::DesktopSource& desktop = mirror_->session();
  desktop.sendKey(kShift, true);
  for (const std::uint32_t keysym : keysymsOf(U"AbC/7@")) tap(desktop, keysym);
  desktop.sendKey(kShift, false);
  type(U" zy äÖ@€ł");
  EXPECT_EQ(line(*mirror_), "AbC/7@ zy äÖ@€ł\n");
}

TEST_F(LocalInput, ShortcutsArrive) {
  start(startXvfb({800, 600}));
  for (const std::uint32_t keysym : keysymsOf(U"wrong")) tap(mirror_->session(), keysym);
  mirror_->session().sendKey(kControl, true);
  tap(mirror_->session(), 'u');  // a line from its beginning
  mirror_->session().sendKey(kControl, false);
  type(U"right");
  EXPECT_EQ(line(*mirror_), "right\n");
}

TEST_F(LocalInput, ThePointerAndItsButtonsArrive) {
  const auto x = startXvfb({800, 600});
  const fs::path log = folder_ / "events";
  const Process events({"stdbuf", "-oL", "xev", "-root", "-event", "mouse"},
                       {.environment = {"DISPLAY=" + x->display()}, .log = log});
  const auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  const auto counts = [&log](const std::string& word) {
    const std::string text = textOf(log);
    std::size_t count = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
  };
  // xev is there once it sees the pointer move.
  int x0 = 0;
  ASSERT_TRUE(mirror->pumpUntil([&] {
    mirror->session().sendPointer(++x0 % 100, 7, 0);
    return counts("MotionNotify") > 0;
  }));
  for (const unsigned buttons : {0x01u, 0x00u, 0x04u, 0x00u, 0x08u, 0x00u, 0x80u, 0x00u}) {
    mirror->session().sendPointer(321, 123, static_cast<std::uint8_t>(buttons));
  }
  EXPECT_TRUE(mirror->pumpUntil([&] { return counts("ButtonRelease") == 4; })) << textOf(log);
  EXPECT_EQ(counts("ButtonPress"), 4u);
  for (const char* button : {"button 1", "button 3", "button 4", "button 8"}) EXPECT_EQ(counts(button), 2u) << button;
  EXPECT_THAT(textOf(log), HasSubstr("root:(321,123)"));
}

TEST_F(LocalInput, KeysAreLetGoAndTheLayoutIsAsBeforeWhenASessionEnds) {
  const auto x = startXvfb({800, 600});
  const std::string before = x->query({"xmodmap", "-pke"});
  auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  mirror->session().sendKey(kControl, true);
  mirror->session().sendKey(kUnicode + 0x20ac, true);
  ASSERT_TRUE(mirror->pumpUntil([&] { return x->query({"xmodmap", "-pke"}) != before; }));
  mirror.reset();
  EXPECT_TRUE(x->query({"xmodmap", "-pke"}) == before);
}

TEST_F(LocalInput, ViewOnlySendsNothing) {
  const auto x = startXvfb({800, 600});
  x->query({"xdotool", "mousemove", "400", "300"});
  DesktopMirror mirror(makeLocal({.display = viewer::parseXDisplay(x->display()), .viewOnly = true}));
  ASSERT_TRUE(mirror.pumpUntilEqual(x->display())) << mirror.summary();
  mirror.session().sendPointer(1, 2, 1);
  mirror.session().sendClipboard("no");
  mirror.pumpFor(300ms);
  EXPECT_THAT(x->query({"xdotool", "getmouselocation"}), HasSubstr("x:400 y:300"));
}

TEST_F(LocalInput, WhatIsCopiedOnTheDesktopComesHere) {
  const auto x = startXvfb({640, 480});
  const auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  for (const std::size_t bytes : {10u, 100'000u, 3'000'000u}) {
    const std::string text = textOfSize(bytes);
    const fs::path file = folder_ / std::to_string(bytes);
    writeText(file, text);
    x->start({"xclip", "-selection", "clipboard", "-in", "-quiet", file.string()});
    EXPECT_TRUE(mirror->pumpUntil([&] { return mirror->last<Clipboard>() == Clipboard{text}; })) << bytes;
  }
}

TEST_F(LocalInput, WhatIsCopiedHereIsPastedOnTheDesktop) {
  const auto x = startXvfb({640, 480});
  const auto mirror = mirrorOf(x->display());
  ASSERT_TRUE(mirror->pumpUntilEqual(x->display())) << mirror->summary();
  const auto paste = [&](const char* target) {
    return run({"timeout", "10", "xclip", "-selection", "clipboard", "-out", "-target", target},
               {"DISPLAY=" + x->display()})
        .text;
  };
  for (const std::size_t bytes : {10u, 100'000u, 3'000'000u}) {
    const std::string text = textOfSize(bytes);
    mirror->session().sendClipboard(text);
    EXPECT_TRUE(mirror->pumpUntil([&] { return paste("UTF8_STRING") == text; })) << bytes;
  }
  EXPECT_THAT(paste("TARGETS"), HasSubstr("UTF8_STRING"));
  mirror->session().sendClipboard("größer €");
  EXPECT_TRUE(mirror->pumpUntil([&] {
    return paste("STRING") ==
           "gr\xf6\xdf"
           "er ?";
  }));
}

TEST_F(LocalInput, TheBellIsHeard) {
  start(startXvfb({800, 600}));
  type(U"$(printf '\\a' > /dev/tty)");
  const auto heard = [&] { return mirror_->last<Bell>().has_value(); };
  x_->start({"xterm", "-e", "bash", "-c", "printf '\\a'; sleep 20"});
  EXPECT_TRUE(mirror_->pumpUntil(heard)) << mirror_->summary();
}

}  // namespace
}  // namespace pixelflex::testing
