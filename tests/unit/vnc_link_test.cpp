// How a connection's settings follow what it carries.
#include <gtest/gtest.h>

#include "viewer/vnc/link_tuner.h"

namespace pixelflex::viewer {
namespace {

using namespace std::chrono_literals;

/// A connection that carries so many bits per second, second after second.
class Line {
 public:
  explicit Line(LinkTuner& tuner) : tuner_(tuner) {}
  /// How often the settings changed.
  int carry(double megabits, int seconds) {
    int changes = 0;
    for (int i = 0; i < seconds; ++i) {
      now_ += 1s;
      changes += tuner_.received(static_cast<std::uint64_t>(megabits * 125'000), 1s, now_) ? 1 : 0;
    }
    return changes;
  }

 private:
  LinkTuner& tuner_;
  LinkTuner::Time now_{1h};
};

TEST(LinkTuner, BeginsGoodNearbyAndModestFarAway) {
  EXPECT_EQ(LinkTuner(300us).settings(), settingsFor(Link::kLan));
  EXPECT_LT(LinkTuner(60ms).settings().quality, 8);
}

TEST(LinkTuner, TheFirstPictureDecidesAtOnce) {
  LinkTuner tuner(10ms);
  EXPECT_EQ(Line(tuner).carry(3, 1), 1);
  EXPECT_EQ(tuner.settings(), settingsFor(Link::kWan));
  EXPECT_NEAR(tuner.rate(), 3e6, 1);
}

TEST(LinkTuner, AFastConnectionStaysAsItIs) {
  LinkTuner tuner(10ms);
  EXPECT_EQ(Line(tuner).carry(300, 100), 0);
  EXPECT_EQ(tuner.settings().quality, 9);
}

TEST(LinkTuner, OneSlowSecondChangesNothing) {
  LinkTuner tuner(10ms);
  Line line(tuner);
  line.carry(300, 5);
  EXPECT_EQ(line.carry(3, 1), 0);
  EXPECT_EQ(line.carry(300, 5), 0);
  EXPECT_EQ(line.carry(3, 2), 1);
  EXPECT_EQ(tuner.settings(), settingsFor(Link::kWan));
}

TEST(LinkTuner, RisesStepByStepWhenThereIsRoom) {
  LinkTuner tuner(10ms);
  Line line(tuner);
  line.carry(0.5, 1);
  EXPECT_EQ(tuner.settings().quality, 3);
  EXPECT_EQ(line.carry(200, 9), 0) << "too soon";
  EXPECT_EQ(line.carry(200, 60), 4);
  EXPECT_EQ(tuner.settings().quality, 9);
}

TEST(LinkTuner, DoesNotSwingAtABorder) {
  LinkTuner tuner(10ms);
  Line line(tuner);
  line.carry(15.9, 5);
  int changes = 0;
  for (int i = 0; i < 200; ++i) changes += line.carry(i % 3 == 0 ? 15 : 18, 3);
  EXPECT_EQ(changes, 0);
}

TEST(LinkTuner, AServerNearbyThatIsSlowItselfKeepsItsQuality) {
  LinkTuner tuner(300us);
  tuner.setRoundTrip(300us);
  EXPECT_EQ(Line(tuner).carry(1, 20), 1);
  EXPECT_EQ(tuner.settings().quality, 8);
}

TEST(LinkTuner, AFewBytesTellNothing) {
  LinkTuner tuner(10ms);
  for (int i = 0; i < 10'000; ++i) EXPECT_FALSE(tuner.received(500, 20ms, LinkTuner::Time(1h + i * 1s)));
  EXPECT_EQ(tuner.rate(), 0);
}

}  // namespace
}  // namespace pixelflex::viewer
