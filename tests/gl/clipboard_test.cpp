// The X clipboard against xclip, which copies and pastes as other programs do; monitors and the screen saver.
#include "devices/display/clipboard.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <xcb/screensaver.h>
#include <xcb/xcb.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>

#include "devices/display/display_watch.h"
#include "tests/gl/x_server.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::devices {
namespace {

using namespace std::chrono_literals;

class ClipboardTest : public ::testing::Test {
 protected:
  explicit ClipboardTest(Selection selection = Selection::kClipboard)
      : xclip_(std::string("xclip -selection ") + (selection == Selection::kPrimary ? "primary" : "clipboard")),
        server_(320, 240),
        clipboard_(selection, 200'000,
                   {[this](std::string text) { receive(std::move(text)); }, [this] { receive("too long"); }}) {}

  void receive(std::string text) {
    const std::scoped_lock lock(mutex_);
    all_ += text;
    received_ = std::move(text);
    arrived_.notify_all();
  }
  bool receives(const std::string& text) {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, 20s, [&] { return received_ == text; });
  }
  void copyWithXclip(const std::string& text) const {
    const auto file = folder_ / "text";
    std::ofstream(file, std::ios::binary) << text;
    ASSERT_EQ(std::system((xclip_ + " -i " + file.string()).c_str()), 0);
  }
  /// Empty as long as the clipboard is not ours.
  [[nodiscard]] std::string pasteWithXclip() const {
    std::string text;
    FILE* const pipe = popen((xclip_ + " -o -t UTF8_STRING 2>/dev/null").c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    pclose(pipe);
    return text;
  }
  [[nodiscard]] bool pastes(const std::string& text) const {
    for (int i = 0; i < 200 && pasteWithXclip() != text; ++i) usleep(50'000);
    return pasteWithXclip() == text;
  }

  const testing::TemporaryFolder folder_;
  const std::string xclip_;
  testing::XServer server_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::string received_;
  std::string all_;
  Clipboard clipboard_;
};

std::string longText(std::size_t size) {
  std::string text;
  while (text.size() < size) text += std::to_string(text.size()) + " ä€ ";
  return text;
}

TEST_F(ClipboardTest, TakesWhatOthersCopy) {
  copyWithXclip("ten bytes!");
  EXPECT_TRUE(receives("ten bytes!"));
  copyWithXclip("äöß€ 你好\n");
  EXPECT_TRUE(receives("äöß€ 你好\n"));
}

TEST_F(ClipboardTest, TakesLongTextsUpToItsLimit) {
  const std::string text = longText(100'000);
  copyWithXclip(text);
  EXPECT_TRUE(receives(text));
  copyWithXclip(longText(200'001));
  EXPECT_TRUE(receives("too long"));
  copyWithXclip("ten bytes!");
  EXPECT_TRUE(receives("ten bytes!"));
  copyWithXclip(longText(3'000'000));  // in parts
  EXPECT_TRUE(receives("too long"));
  copyWithXclip("after");
  EXPECT_TRUE(receives("after")) << "a text that is too long leaves no harm";
}

TEST_F(ClipboardTest, GivesOthersWhatItWasGiven) {
  clipboard_.set("ten bytes!");
  EXPECT_TRUE(pastes("ten bytes!"));
  clipboard_.set("äöß€ 你好\n");
  EXPECT_TRUE(pastes("äöß€ 你好\n"));
}

TEST_F(ClipboardTest, GivesLongTextsInParts) {
  const std::string text = longText(1'300'000);
  clipboard_.set(text);
  EXPECT_TRUE(pastes(text));
}

class PrimaryTest : public ClipboardTest {
 protected:
  PrimaryTest() : ClipboardTest(Selection::kPrimary) {}
};

TEST_F(PrimaryTest, IsWhatOthersMarkAndPasteWithTheMiddleButton) {
  copyWithXclip("markiert");
  EXPECT_TRUE(receives("markiert"));
  clipboard_.set("from here");
  EXPECT_TRUE(pastes("from here"));
}

TEST_F(PrimaryTest, IsNotTheClipboard) {
  ASSERT_EQ(std::system("echo copied | xclip -selection clipboard -i"), 0);
  copyWithXclip("marked");
  EXPECT_TRUE(receives("marked"));
  const std::scoped_lock lock(mutex_);
  EXPECT_EQ(all_, "marked");
}

bool isBlanked(const std::string& display) {
  xcb_connection_t* const x = xcb_connect(display.c_str(), nullptr);
  const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(x)).data->root;
  auto* const info = xcb_screensaver_query_info_reply(x, xcb_screensaver_query_info(x, root), nullptr);
  const bool blanked = info != nullptr && info->state == XCB_SCREENSAVER_STATE_ON;
  std::free(info);
  xcb_disconnect(x);
  return blanked;
}

TEST(DisplayWatchTest, HoldsTheScreenSaverOff) {
  const testing::XServer watched(64, 64);
  const DisplayWatch watch([] {});
  ASSERT_EQ(std::system("xset s 1 1"), 0);
  const testing::XServer other(64, 64);
  ASSERT_EQ(std::system("xset s 1 1"), 0);
  for (int i = 0; i < 400 && !isBlanked(other.display()); ++i) usleep(50'000);
  EXPECT_TRUE(isBlanked(other.display()));
  EXPECT_FALSE(isBlanked(watched.display()));
}

TEST(DisplayWatchTest, TellsOfMonitorsThatComeAndGo) {
  const testing::XServer server(320, 240);
  std::mutex mutex;
  std::condition_variable told;
  int changes = 0;
  const DisplayWatch watch([&] {
    const std::scoped_lock lock(mutex);
    ++changes;
    told.notify_all();
  });
  ASSERT_EQ(std::system("xrandr --setmonitor left 160/40x240/60+0+0 none --fb 320x240 --dpi 91"), 0);
  std::unique_lock lock(mutex);
  EXPECT_TRUE(told.wait_for(lock, 20s, [&] { return changes > 0; }));
}

}  // namespace
}  // namespace pixelflex::devices
