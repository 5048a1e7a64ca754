// Copying on one side of the wall and pasting on the other, by real X clients.
#include "tests/e2e/view_screens.h"

namespace pixelflex::testing {
namespace {

std::string longText() {
  std::string text;
  while (text.size() < 100'000) text += std::to_string(text.size()) + " äß€\n";
  return text;
}

/// The desktop comes through VNC, or straight from its X server.
class ClipboardTest : public ScreensTest, public ::testing::WithParamInterface<const char*> {
 protected:
  void startSession(std::vector<std::string> more = {}) {
    makeWall({{100, 90}});
    const bool vnc = std::string(GetParam()) == "vnc";
    startViewerOf(vnc ? desktop_->unixAddress() : "x11:" + desktop_->x().display(), std::move(more));
    waitForPicture({100, 90});
  }
  /// The program that copies stays: what others paste comes from it.
  void copyOn(XServer& x, const std::string& text, const std::string& selection = "clipboard") {
    const auto file = folder_ / ("copied" + std::to_string(++copies_));
    writeText(file, text);
    x.start({"xclip", "-selection", selection, "-quiet", "-i", file.string()});
    ASSERT_TRUE(pastesOn(x, text, selection)) << "where it was copied";
  }
  static bool pastesOn(XServer& x, const std::string& text, const std::string& selection = "clipboard") {
    return comesTrue([&] {
      return answer(x, {"timeout", "5", "xclip", "-selection", selection, "-o", "-t", "UTF8_STRING"}) == text;
    });
  }
  /// There and back again, so that each side has to give up what it had.
  void expectBothWays(const std::string& text) {
    copyOn(screen_, text + "1");
    EXPECT_TRUE(pastesOn(desktop_->x(), text + "1")) << text.size() << log();
    copyOn(desktop_->x(), text + "2");
    EXPECT_TRUE(pastesOn(screen_, text + "2")) << text.size() << log();
  }
  int copies_ = 0;
};

TEST_P(ClipboardTest, WhatIsCopiedOnEitherSideIsPastedOnTheOther) {
  startSession();
  expectBothWays("ten bytes!");
  expectBothWays("Grüße, 你好 → ok");
  expectBothWays(longText());
}

TEST_P(ClipboardTest, WhatIsMarkedOnEitherSideIsPastedOnTheOther) {
  startSession();
  copyOn(screen_, "marked here", "primary");
  EXPECT_TRUE(pastesOn(desktop_->x(), "marked here", "primary")) << log();
  copyOn(desktop_->x(), "marked there", "primary");
  EXPECT_TRUE(pastesOn(screen_, "marked there", "primary")) << log();
}

TEST_P(ClipboardTest, WhatIsMarkedStaysAloneWhenThatIsWished) {
  startSession({"--primary", "off"});
  copyOn(screen_, "marked here", "primary");
  expectBothWays("copied");
  EXPECT_EQ(answer(screen_, {"xclip", "-selection", "primary", "-o"}), "marked here");
}

TEST_P(ClipboardTest, LongTextsAreRefusedOnceInWordsAndDoNoHarm) {
  startSession({"--clipboard-limit", "5000"});
  copyOn(screen_, longText() + "1");
  EXPECT_TRUE(comesTrue([&] { return logHolds("more than 5000 bytes was copied here and stays there"); })) << log();
  copyOn(desktop_->x(), longText() + "2");
  EXPECT_TRUE(comesTrue([&] { return logHolds("more than 5000 bytes was copied on the desktop and stays"); })) << log();
  const std::string said = log();
  copyOn(screen_, longText() + "3");
  copyOn(desktop_->x(), longText() + "4");
  expectBothWays("short");
  EXPECT_EQ(log(), said);
}

INSTANTIATE_TEST_SUITE_P(Through, ClipboardTest, ::testing::Values("vnc", "x11"),
                         [](const auto& source) { return std::string(source.param); });

}  // namespace
}  // namespace pixelflex::testing
