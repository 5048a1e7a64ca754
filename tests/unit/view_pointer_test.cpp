// What finds the pointer: the gesture and the ring.
#include <gtest/gtest.h>

#include "viewer/programs/control_taps.h"
#include "viewer/programs/modifier_keys.h"

namespace pixelflex::viewer {
namespace {

using namespace std::chrono_literals;

/// Presses and releases a key `gap` after the last stroke; what the release says.
class Hand {
 public:
  bool tap(std::uint32_t keysym, std::chrono::milliseconds gap = 60ms) {
    now_ += gap;
    const bool pressed = taps.key(keysym, true, now_);
    now_ += gap;
    return taps.key(keysym, false, now_) || pressed;
  }
  ControlTaps taps;

 private:
  ControlTaps::Clock::time_point now_{1h};
};

TEST(ControlTaps, AreTwoInQuickSuccession) {
  Hand hand;
  EXPECT_FALSE(hand.tap(kControlLeft));
  EXPECT_TRUE(hand.tap(kControlLeft));
  EXPECT_FALSE(hand.tap(kControlLeft)) << "two more are needed";
  EXPECT_TRUE(hand.tap(kControlLeft));
  EXPECT_FALSE(hand.tap(kControlRight, 300ms));
  EXPECT_FALSE(hand.tap(kControlRight, 300ms)) << "too slow";
}

TEST(ControlTaps, AreOfOneKeyAndNothingElse) {
  Hand hand;
  EXPECT_FALSE(hand.tap(kControlLeft));
  EXPECT_FALSE(hand.tap(kControlRight));
  EXPECT_FALSE(hand.tap(kControlLeft));
  EXPECT_FALSE(hand.tap('c'));
  EXPECT_FALSE(hand.tap(kControlLeft));
  hand.taps.forget();
  EXPECT_FALSE(hand.tap(kControlLeft)) << "a button came in between";
  EXPECT_TRUE(hand.tap(kControlLeft));
}

TEST(ControlTaps, AreNotAKeyThatRepeats) {
  ControlTaps taps;
  const ControlTaps::Clock::time_point start{1h};
  for (int i = 0; i < 8; ++i) EXPECT_FALSE(taps.key(kControlLeft, true, start + i * 30ms));
  EXPECT_FALSE(taps.key(kControlLeft, false, start + 300ms));
}

}  // namespace
}  // namespace pixelflex::viewer
