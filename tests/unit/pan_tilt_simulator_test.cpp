#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "devices/simulate/pan_tilt_simulator.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using devices::PanTiltSimulator;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// The unit with a clock that only the test turns.
class PanTiltSimulatorTest : public ::testing::Test {
 protected:
  /// What the unit says to `command` in so much time.
  std::string say(const std::string& command, milliseconds wait = milliseconds(0)) {
    unit_.receive(command, now_);
    return listen(wait);
  }
  std::string listen(milliseconds wait) {
    now_ += wait;
    unit_.advance(now_);
    return unit_.take(now_);
  }
  int pan() { return static_cast<int>(unit_.motor(PanTiltSimulator::kPan).position); }

  PanTiltSimulator unit_;
  PanTiltSimulator::Time now_{seconds(1000)};
};

// The manual's session.
TEST_F(PanTiltSimulatorTest, SpeaksTheManualsTranscript) {
  EXPECT_EQ(say("ED ", seconds(0)), "ED *\r\n");
  EXPECT_EQ(say("R ", seconds(40)), "!T!T!P!P*\r\n");
  EXPECT_EQ(say("PN "), "* Minimum Pan position is -3090\r\n");
  EXPECT_EQ(say("PX "), "* Maximum Pan position is 3090\r\n");
  EXPECT_EQ(say("TN "), "* Minimum Tilt position is -907\r\n");
  EXPECT_EQ(say("TX "), "* Maximum Tilt position is 604\r\n");
  EXPECT_EQ(say("PR "), "* 185.1428 seconds arc per position\r\n");
  EXPECT_EQ(say("PP3200 "), "! Maximum allowable Pan position is 3090\r\n");
  EXPECT_EQ(say("LD "), "*\r\n");
  EXPECT_EQ(say("L "), "* Limit bounds are DISABLED (hard limits only: use care)\r\n");
  EXPECT_EQ(say("PP3200 "), "*\r\n");
  EXPECT_EQ(say("A ", seconds(60)), "*\r\n");
  EXPECT_EQ(say("PP "), "* Current Pan position is 3200\r\n");
  EXPECT_EQ(say("FT "), "*\r\n");
  EXPECT_EQ(say("PP "), "* 3200\r\n");
  EXPECT_EQ(say("PL20 "), "! Motor speed cannot be less than 31 pos/sec\r\n");
  EXPECT_EQ(say("PS3000 "), "! Pan speed cannot exceed 2902 positions/sec\r\n");
  EXPECT_EQ(say("PP-500 A PO1500 A PP ", seconds(120)), "*\r\n*\r\n*\r\n*\r\n* 1000\r\n");
}

TEST_F(PanTiltSimulatorTest, EchoesUntilTold) {
  EXPECT_EQ(say("pp "), "pp * Current Pan position is 0\r\n");
  EXPECT_EQ(say("ED\n"), "ED\n*\r\n");
  EXPECT_EQ(say("E\r"), "* Echoing OFF\r\n");
}

TEST_F(PanTiltSimulatorTest, MovesAsTheManualsTrapezoid) {
  (void)say("ED PB200 PA1000 PS800 ");
  (void)say("PP2000 ");
  // 0.6 s of ramp over 300 counts at each end, the rest at 800 counts/s: 0.6 + 1.75 + 0.6 s.
  (void)listen(milliseconds(600));
  EXPECT_NEAR(pan(), 300, 10);
  (void)listen(milliseconds(1000));
  EXPECT_NEAR(pan(), 1100, 10);
  (void)listen(milliseconds(1300));
  EXPECT_LT(pan(), 2000);
  (void)listen(milliseconds(100));
  EXPECT_EQ(pan(), 2000);
}

TEST_F(PanTiltSimulatorTest, HaltsWhereItIs) {
  (void)say("ED PP3000 ");
  (void)listen(milliseconds(500));
  EXPECT_TRUE(unit_.isMoving());
  EXPECT_EQ(say("H "), "*\r\n");
  EXPECT_FALSE(unit_.isMoving());
  const int where = pan();
  (void)listen(seconds(5));
  EXPECT_EQ(pan(), where);
}

TEST_F(PanTiltSimulatorTest, SlavedMovesWaitForTheirRelease) {
  (void)say("ED S PP100 TP50 ", seconds(5));
  EXPECT_EQ(pan(), 0);
  EXPECT_EQ(say("I ", seconds(5)), "*\r\n");
  EXPECT_EQ(pan(), 100);
  EXPECT_EQ(unit_.motor(PanTiltSimulator::kTilt).position, 50);
}

TEST_F(PanTiltSimulatorTest, AwaitAnswersOnlyWhenAllStands) {
  (void)say("ED PP2000 ");
  EXPECT_EQ(say("A PP ", seconds(1)), "");
  EXPECT_EQ(listen(seconds(5)), "*\r\n* Current Pan position is 2000\r\n");
}

TEST_F(PanTiltSimulatorTest, ForgetsItsModesWithThePower) {
  (void)say("ED FT LD PS500 PP100 ", seconds(5));
  unit_.powerCycle(now_);
  EXPECT_EQ(say("PP "), "PP * Current Pan position is 100\r\n");
  EXPECT_EQ(unit_.motor(PanTiltSimulator::kPan).speed, 1000);
}

TEST_F(PanTiltSimulatorTest, AStuckAxisDoesNotGetThere) {
  (void)say("ED FT ");
  unit_.order(Fault::kStuck);
  EXPECT_EQ(say("PP100 ", seconds(5)), "*\r\n");
  EXPECT_EQ(say("PP "), "* 0\r\n");
  unit_.heal();
  (void)listen(seconds(5));
  EXPECT_EQ(say("PP "), "* 100\r\n");
}

TEST_F(PanTiltSimulatorTest, RepliesCanBeDamagedSlowedAndLost) {
  (void)say("ED FT ");
  unit_.order(Fault::kDrop, 1);
  EXPECT_EQ(say("PP "), " 0\r\n");
  EXPECT_EQ(say("PP "), "* 0\r\n");
  unit_.order(Fault::kGarble, 1);
  EXPECT_EQ(say("PP "), "j 0\r\n");
  unit_.order(Fault::kSilent, 1);
  EXPECT_EQ(say("PP "), "");
  unit_.order(Fault::kSlow, 1);
  EXPECT_EQ(say("PP "), "");
  EXPECT_EQ(listen(PanTiltSimulator::kSlowness), "* 0\r\n");
}

TEST_F(PanTiltSimulatorTest, RefusesNonsenseAndBoundsIt) {
  (void)say("ED ");
  EXPECT_EQ(say("XYZ "), "! Illegal command\r\n");
  EXPECT_EQ(say("PPx "), "! Illegal argument\r\n");
  EXPECT_EQ(say("PP99999999999 "), "! Illegal argument\r\n");
  EXPECT_EQ(say(std::string(100000, 'Q') + " "), "! Illegal command\r\n");
}

}  // namespace
}  // namespace pixelflex::testing
