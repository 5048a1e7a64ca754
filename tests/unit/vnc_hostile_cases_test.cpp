// Named servers that do one wrong thing each. Every session ends cleanly and says what it was.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using ::testing::HasSubstr;

struct Hostile {
  std::string name;
  Message bytes;
  CloseKind kind = CloseKind::kProtocol;
  std::string says;
};

void PrintTo(const Hostile& hostile, std::ostream* out) {
  *out << hostile.name;
}

class HostileCase : public ::testing::TestWithParam<Hostile> {};

// The server says everything at once, whatever is answered, and hangs up.
TEST_P(HostileCase, EndsItsOwnSessionAndNothingElse) {
  const FakeVncServer server([](FakeConnection& client) { client.send(GetParam().bytes); });
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.user = "operator";
  options.password = "secret";
  DesktopMirror mirror(options);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>()->kind, GetParam().kind) << mirror.last<Closed>()->message;
  EXPECT_THAT(mirror.last<Closed>()->message, HasSubstr(GetParam().says));
}

std::string nameOf(const ::testing::TestParamInfo<Hostile>& info) {
  return info.param.name;
}

Message hello() {
  return Message().text("RFB 003.008\n");
}

// VeNCrypt up to its list of sub-types.
Message venCrypt() {
  return hello().u8(1).u8(19).u8(0).u8(2).u8(0);
}

std::vector<Hostile> handshakes() {
  using enum CloseKind;
  return {
      {"SaysNothing", Message(), kLost, "closed the connection during the handshake"},
      {"HalfAGreeting", Message().text("RFB 003.0"), kLost, "during the handshake"},
      {"WebServer", Message().text("HTTP/1.1 200 OK\r\n\r\n"), kNotVnc, "HTTP/1.1 200"},
      {"ShellServer", Message().text("SSH-2.0-OpenSSH_9\r\n"), kNotVnc, "SSH-2.0-Open"},
      {"VersionWithoutNumbers", Message().text("RFB abc.def\n"), kNotVnc, "RFB abc.def"},
      {"VersionWithoutEnd", Message().text("RFB 003.0088"), kNotVnc, "RFB 003.0088"},
      {"ZeroesOnly", Message().repeat(0, 4096), kNotVnc, "........"},
      {"OldVersionOfUnknownType", Message().text("RFB 000.000\n").u32(0xffffffff), kUntrusted, "4294967295"},
      {"RefusesWithoutReason", hello().u8(0), kAuthentication, "refused the connection"},
      {"RefusesWithAReasonWithoutEnd", hello().u8(0).u32(0xffffffff).repeat('x', 5000), kAuthentication, "xxx"},
      {"TypesCutOff", hello().u8(200).u8(1), kLost, "during the handshake"},
      {"ManyUnknownTypes", hello().u8(255).repeat(99, 255), kUntrusted, "no security type known"},
      {"ChallengeCutOff", hello().u8(1).u8(2).repeat(7, 15), kLost, "during the handshake"},
      {"TooManyAttempts", hello().u8(1).u8(2).repeat(7, 16).u32(2).u32(4).text("wait"), kAuthentication, "wait"},
      {"ResultOfNoMeaning", hello().u8(1).u8(1).u32(0xdeadbeef), kAuthentication, "refused the connection"},
      {"VenCryptVersionRefused", hello().u8(1).u8(19).u8(9).u8(9).u8(1), kUntrusted, "version 0.2"},
      {"VenCryptWithoutTypes", venCrypt().u8(0), kUntrusted, "offers nothing"},
      {"VenCryptManyUnknownTypes", venCrypt().u8(255).repeat(0xee, 1020), kUntrusted, "no security type known"},
      {"VenCryptTypesCutOff", venCrypt().u8(3).u32(257), kLost, "during the handshake"},
      {"PlainPasswordOnly", venCrypt().u8(1).u32(256), kUntrusted, "offers Plain"},
      {"TlsThatDoesNotBegin", venCrypt().u8(1).u32(258).u8(0), kUntrusted, "does not begin"},
      {"TlsOfNonsense", venCrypt().u8(1).u32(261).u8(1).repeat(0x16, 3000), kUntrusted, "no encrypted connection"},
      {"TlsAlert", venCrypt().u8(1).u32(262).u8(1).u8(21).u16(0x303).u16(2).u8(2).u8(40), kUntrusted,
       "no encrypted connection"},
      {"TlsHugeRecord", venCrypt().u8(1).u32(257).u8(1).u8(22).u16(0x303).u16(0xffff).repeat(2, 70000), kUntrusted,
       "no encrypted connection"},
      {"TlsCutOff", venCrypt().u8(1).u32(260).u8(1).u8(22).u16(0x303).u16(200), kUntrusted, "no encrypted connection"},
      {"NoPixels", FakeConnection::greeting({0, 0}), kProtocol, "a desktop of 0x0"},
      {"NoColumns", FakeConnection::greeting({0, 100}), kProtocol, "a desktop of 0x100"},
      {"NoRows", FakeConnection::greeting({100, 0}), kProtocol, "a desktop of 100x0"},
      {"LargestOfAll", FakeConnection::greeting({65535, 65535}), kTooLarge, "65535x65535"},
      {"OneTooWide", FakeConnection::greeting({16385, 1}), kTooLarge, "16385x1"},
      {"NameTooLong", FakeConnection::greeting({9, 9}, std::string(70'000, 'x')), kProtocol, "name of 70000 bytes"},
  };
}

INSTANTIATE_TEST_SUITE_P(Handshake, HostileCase, ::testing::ValuesIn(handshakes()), nameOf);

// After the handshake of a desktop of 64x48 pixels.
Message later(const Message& bytes) {
  return FakeConnection::greeting({64, 48}).append(bytes);
}

Message rect(int x, int y, int w, int h, std::int32_t encoding) {
  return Message().update(1).rect(x, y, w, h, encoding);
}

Message tight(int w, int h) {
  return rect(0, 0, w, h, kTightEncoding);
}

std::vector<Hostile> rectangles() {
  using enum CloseKind;
  const auto bad = [](const char* name, const Message& bytes, const char* says, CloseKind kind = kProtocol) {
    return Hostile{name, later(bytes), kind, says};
  };
  return {
      bad("RightOfTheDesktop", rect(60, 0, 10, 10, 0), "that lies outside its desktop: 10x10 at 60, 0"),
      bad("BelowTheDesktop", rect(0, 48, 1, 1, 7), "that lies outside its desktop"),
      bad("FarOutside", rect(65535, 65535, 65535, 65535, 16), "that lies outside its desktop"),
      bad("CopyFromOutside", rect(0, 0, 10, 10, 1).u16(60).u16(40), "that copies from outside its desktop"),
      bad("CopyFromFarOutside", rect(0, 0, 64, 48, 1).u16(65535).u16(65535), "that copies from outside"),
      bad("UnknownEncoding", rect(0, 0, 1, 1, 12345), "encoding 12345"),
      bad("RreNotAskedFor", rect(0, 0, 8, 8, 2).u32(0xffffffff), "encoding 2"),
      bad("CoRreNotAskedFor", rect(0, 0, 8, 8, 4).u32(0xffffffff), "encoding 4"),
      bad("HextileNotAskedFor", rect(0, 0, 8, 8, 5).repeat(255, 99), "encoding 5"),
      bad("ZlibNotAskedFor", rect(0, 0, 8, 8, 6).u32(0x7fffffff), "encoding 6"),
      bad("UltraNotAskedFor", rect(0, 0, 8, 8, 9).u32(0x7fffffff), "encoding 9"),
      bad("TrleNotAskedFor", rect(0, 0, 8, 8, 15).u8(130), "encoding 15"),
      bad("UltraZipNotAskedFor", rect(65535, 0, 8, 0, -65527), "not asked for"),
      bad("ServerIdentityNotAskedFor", rect(0, 0, 65535, 1, -65533), "not asked for"),
      bad("ExtendedDesktopSizeNotAskedFor", rect(0, 0, 64, 48, -308).u8(255), "encoding -308"),
      bad("ShrinksToNothing", rect(0, 0, 0, 0, -223), "a desktop of 0x0"),
      bad("GrowsTooLarge", rect(0, 0, 16385, 48, -223), "16385x48", kTooLarge),
      bad("RectangleOfTheOldSize", Message().update(2).rect(0, 0, 8, 8, -223).rect(0, 0, 64, 48, 7), "outside"),
      bad("UpdateCutOff", Message().update(65535).rect(0, 0, 1, 1, 0).repeat(0, 4), "in the middle of an update",
          kLost),
      bad("PixelsCutOff", rect(0, 0, 64, 48, 0).repeat(9, 12287), "in the middle of an update", kLost),
      bad("TightLengthCutOff", tight(8, 8).u8(0).u8(0xff), "in the middle of an update", kLost),
      bad("TightUnknownControl", tight(8, 8).u8(0xf0).repeat(0, 99), "not valid VNC"),
      bad("TightUnknownFilter", tight(8, 8).u8(0x40).u8(9), "filter"),
      bad("TightBrokenStream", tight(8, 8).u8(0).u8(20).repeat(0xee, 20), "nflate"),
      bad("TightStreamTooLong", tight(8, 8).u8(0).u8(0xff).u8(0xff).u8(0xff).repeat(0, 5000), "closed", kLost),
      bad("TightPaletteCutOff", tight(64, 48).u8(0x40).u8(1).u8(255).repeat(1, 700), "in the middle", kLost),
      bad("TightJpegOfNonsense", tight(16, 16).u8(0x90).u8(50).repeat(0xd8, 50), "not valid VNC"),
      bad("TightJpegOfNothing", tight(16, 16).u8(0x90).u8(0), "not valid VNC"),
      bad("ZrleBrokenStream", rect(0, 0, 8, 8, 16).u32(20).repeat(0xee, 20), "not valid VNC"),
      bad("ZrleOfFourGigabytes", rect(0, 0, 8, 8, 16).u32(0xffffffff).repeat(0, 9000), "damaged"),
      bad("ZrleOfNothing", rect(0, 0, 64, 48, 16).u32(0), "damaged"),
  };
}

INSTANTIATE_TEST_SUITE_P(Rectangle, HostileCase, ::testing::ValuesIn(rectangles()), nameOf);

std::vector<Hostile> messages() {
  using enum CloseKind;
  const auto bad = [](const char* name, const Message& bytes, const char* says, CloseKind kind = kProtocol) {
    return Hostile{name, later(bytes), kind, says};
  };
  const Message text = Message().u8(3).repeat(0, 3);
  return {
      bad("UnknownMessage", Message().u8(77), "unknown type 77"),
      bad("TextChatNotAskedFor", Message().u8(11).repeat(0, 3).u32(0xffffffff), "unknown type 11"),
      bad("LastMessageType", Message().u8(255), "unknown type 255"),
      bad("PointerTooLarge", rect(0, 0, 1025, 1, -314).u32(0), "pointer shape of 1025x1"),
      bad("PointerOfUnknownEncoding", rect(0, 0, 64, 48, -314).u32(7), "pointer shape that cannot be read"),
      bad("RichPointerTooLarge", rect(0, 0, 65535, 65535, -239), "pointer shape of 65535x65535"),
      bad("TwoColourPointerTooLarge", rect(0, 0, 1, 2000, -240), "pointer shape of 1x2000"),
      bad("PointerCutOff", rect(0, 0, 32, 32, -239).repeat(1, 4000), "in the middle of an update", kLost),
      bad("FenceTooLong", Message().u8(248).repeat(0, 3).u32(0x80000001).u8(65).repeat(0, 65), "fence"),
      bad("FenceCutOff", Message().u8(248).repeat(0, 3).u32(0x80000001).u8(60).repeat(0, 59), "closed", kLost),
      bad("TextOfTwoGigabytes", Message(text).u32(0x7fffffff).repeat('x', 9000), "closed the connection", kLost),
      bad("TextCutOff", Message(text).u32(1000).repeat('x', 999), "closed the connection", kLost),
      bad("ColourMapCutOff", Message().u8(1).u8(0).u16(0).u16(65535).repeat(1, 999), "closed the connection", kLost),
  };
}

INSTANTIATE_TEST_SUITE_P(Message, HostileCase, ::testing::ValuesIn(messages()), nameOf);

}  // namespace
}  // namespace pixelflex::viewer
