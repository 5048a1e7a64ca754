#include <gtest/gtest.h>

#include <string>

#include "devices/pan_tilt/pan_tilt_reply.h"

namespace pixelflex::testing {
namespace {

using devices::endOfPanTiltReply;
using devices::numberInReply;
using devices::PanTiltReply;
using devices::parsePanTiltReply;

PanTiltReply replyOf(const std::string& bytes) {
  const auto end = endOfPanTiltReply(bytes);
  EXPECT_TRUE(end.has_value()) << bytes;
  return parsePanTiltReply(bytes.substr(0, end.value_or(0)));
}

TEST(PanTiltReply, ReadsEveryMode) {
  for (const std::string bytes :
       {"* 3200\r\n", "* 3200\r", "* 3200\n", "PP * Current Pan position is 3200\r\n", "\n* 3200\r",
        "pp\r\n* Current Pan position is 3200\r\n", "* Target Pan speed is 3200 positions/sec\r\n",
        "* Pan acceleration is 3200 positions/sec^2\r\n"}) {
    const PanTiltReply reply = replyOf(bytes);
    EXPECT_TRUE(reply.success) << bytes;
    EXPECT_EQ(numberInReply(reply.text), 3200) << bytes;
  }
  EXPECT_EQ(numberInReply(replyOf("* 185.1428 seconds arc per Pan position\r\n").text), 185.1428);
  EXPECT_EQ(numberInReply(replyOf("* Current Pan position is -500\r\n").text), -500);
  EXPECT_EQ(numberInReply(replyOf("* Echoing ON\r\n").text), std::nullopt);
  EXPECT_TRUE(replyOf("*\r\n").success);
}

TEST(PanTiltReply, AnErrorIsAnError) {
  const PanTiltReply reply = replyOf("PP3200 ! Maximum allowable Pan position is 3090\r\n");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.text, "Maximum allowable Pan position is 3090");
}

// The unit says so when it meets a stop, whatever it is saying else.
TEST(PanTiltReply, StopsAreHeardAnywhere) {
  const PanTiltReply reset = replyOf("!T!T!P!P*\r\n");
  EXPECT_TRUE(reset.success);
  EXPECT_EQ(reset.panStops, 2);
  EXPECT_EQ(reset.tiltStops, 2);
  const PanTiltReply inside = replyOf("* Current Pan posi!Ption is 1!T7\r\n");
  EXPECT_EQ(inside.text, "Current Pan position is 17");
  EXPECT_EQ(inside.panStops, 1);
  EXPECT_EQ(inside.tiltStops, 1);
}

TEST(PanTiltReply, WaitsForAllOfIt) {
  for (const std::string part : {"", "PP ", "* 32", "!P", "!", "!P!T", "! Max", "\r\n"}) {
    EXPECT_EQ(endOfPanTiltReply(part), std::nullopt) << part;
  }
}

}  // namespace
}  // namespace pixelflex::testing
