// What asks where the pointer is.
#include <gtest/gtest.h>

#include <glm/vec2.hpp>

#include "viewer/programs/control_taps.h"
#include "viewer/programs/modifier_keys.h"
#include "viewer/programs/pointer_shake.h"

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

/// Moves between two points, some steps each way; how often that was a shake.
int shakes(PointerShake& shake, glm::dvec2 from, glm::dvec2 to, int strokes, std::chrono::milliseconds each) {
  constexpr int kSteps = 8;
  PointerShake::Clock::time_point now{1h};
  int count = 0;
  for (int i = 0; i < strokes * kSteps; ++i) {
    const double along = static_cast<double>(i % kSteps) / kSteps;
    const double part = i / kSteps % 2 == 0 ? along : 1 - along;
    count += shake.move(from + (to - from) * part, now) ? 1 : 0;
    now += each / kSteps;
  }
  return count;
}

TEST(PointerShakeTest, IsToAndFroInAnyDirection) {
  for (const glm::dvec2 to : {glm::dvec2(400, 100), glm::dvec2(100, 400), glm::dvec2(-100, -100)}) {
    PointerShake shake;
    EXPECT_EQ(shakes(shake, {100, 100}, to, 6, 120ms), 1) << to.x << " " << to.y;
  }
  PointerShake shake;
  EXPECT_GT(shakes(shake, {0, 0}, {300, 0}, 24, 120ms), 2) << "and goes on";
}

TEST(PointerShakeTest, IsNeitherAimingNorWorking) {
  PointerShake slow;
  EXPECT_EQ(shakes(slow, {100, 100}, {900, 100}, 20, 400ms), 0);
  PointerShake small;
  EXPECT_EQ(shakes(small, {100, 100}, {160, 130}, 40, 60ms), 0);
  PointerShake few;
  EXPECT_EQ(shakes(few, {100, 100}, {900, 100}, 4, 100ms), 0);
  PointerShake clicked;
  EXPECT_EQ(shakes(clicked, {100, 100}, {400, 100}, 4, 100ms), 0);
  clicked.forget();
  EXPECT_EQ(shakes(clicked, {100, 100}, {400, 100}, 4, 100ms), 0);
}

}  // namespace
}  // namespace pixelflex::viewer
