#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "devices/projector_control/beef_frame.h"
#include "devices/projector_control/beef_link.h"
#include "devices/projector_control/pjlink_login.h"

namespace pixelflex::testing {
namespace {

using devices::beefFrame;
using devices::BeefOperation;

std::string bytesOf(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 3) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

// As Hitachi, Christie and ASK Proxima print them.
TEST(BeefFrame, MakesTheFramesThatTheManualsPrint) {
  EXPECT_EQ(beefFrame(BeefOperation::kSet, 0x6000, 1), bytesOf("BE EF 03 06 00 BA D2 01 00 00 60 01 00"));
  EXPECT_EQ(beefFrame(BeefOperation::kIncrement, 0x2401), bytesOf("BE EF 03 06 00 96 92 04 00 01 24 00 00"));
  EXPECT_EQ(beefFrame(BeefOperation::kDecrement, 0x2400), bytesOf("BE EF 03 06 00 BB 92 05 00 00 24 00 00"));
  EXPECT_EQ(beefFrame(BeefOperation::kSet, 0x2405, 1), bytesOf("BE EF 03 06 00 63 92 01 00 05 24 01 00"));
  EXPECT_EQ(beefFrame(BeefOperation::kGet, 0x6020), bytesOf("BE EF 03 06 00 D9 D8 02 00 20 60 00 00"));
  EXPECT_EQ(beefFrame(BeefOperation::kSet, 0x0011, 0x00B2, 0x80), bytesOf("BE EF 80 06 00 2E 04 01 00 11 00 B2 00"));
}

// The vectors of the PJLink specifications, class 1 and version 2.10.
TEST(BeefFrame, IsWrappedForTheNetwork) {
  const std::string frame = bytesOf("BE EF 03 06 00 BA D2 01 00 00 60 01 00");
  // BE + EF + 03 + 06 + BA + D2 + 01 + 60 + 01 + 02 + 0D is 3B3h, and 4D more is 400h.
  EXPECT_EQ(devices::wrappedBeefFrame(frame, 0x7F), bytesOf("02 0D BE EF 03 06 00 BA D2 01 00 00 60 01 00 4D 7F"));
  EXPECT_EQ(devices::pjlinkMd5("a572f60c", "password"), "e3d97429adffa11bce1f7275813d4bde") << "as a manual prints it";
}

TEST(PjlinkLogin, MakesTheDigestsThatTheSpecificationPrints) {
  EXPECT_EQ(devices::pjlinkMd5("498e4a67", "JBMIAProjectorLink"), "5d8409bc1c3fa39749434aa3a5c38682");
  EXPECT_EQ(devices::pjlinkSha256("3db25e10f69c47a85adb24cf361897e0", "c14b279e603d8a5f17e849ba360f2dc5",
                                  "JBMIAProjectorLink"),
            "c14b279e603d8a5f17e849ba360f2dc5"
            "70ab129eac6924d4c129c9c4fcf45be42e1e776325a66db67e5b6eee50f2a692");
}

TEST(PjlinkLogin, RandomNumbersDiffer) {
  const std::string one = devices::pjlinkRandom();
  EXPECT_EQ(one.size(), 32U);
  EXPECT_NE(one, devices::pjlinkRandom());
}

}  // namespace
}  // namespace pixelflex::testing
