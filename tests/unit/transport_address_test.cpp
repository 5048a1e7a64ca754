#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "devices/transport/line_address.h"
#include "devices/transport/telnet_codec.h"

namespace pixelflex::testing {
namespace {

using devices::LineKind;
using devices::parseLineAddress;
using devices::TelnetCodec;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parseLineAddress(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LineAddress, ReadsWhatPeopleWrite) {
  const auto serial = parseLineAddress("serial:/dev/ttyUSB0?baud=19200&bits=7E2");
  EXPECT_EQ(serial.kind, LineKind::kSerial);
  EXPECT_EQ(serial.path, "/dev/ttyUSB0");
  EXPECT_EQ(serial.format, (devices::SerialFormat{19200, 7, 'E', 2}));
  const auto tcp = parseLineAddress("tcp://10.0.0.9:2101");
  EXPECT_EQ(tcp.host, "10.0.0.9");
  EXPECT_EQ(tcp.port, 2101);
  const auto remote = parseLineAddress("rfc2217://[fe80::1]:2001?baud=38400");
  EXPECT_EQ(remote.kind, LineKind::kRfc2217);
  EXPECT_EQ(remote.host, "fe80::1");
  EXPECT_EQ(remote.format.baud, 38400);
  EXPECT_EQ(parseLineAddress("sim:ptu?fault=slow").simulator, "ptu?fault=slow");
}

TEST(LineAddress, TakesTheDevicesUsualFormat) {
  const devices::SerialFormat usual{19200, 8, 'N', 1};
  EXPECT_EQ(parseLineAddress("serial:/dev/ttyS0", usual).format, usual);
  EXPECT_EQ(parseLineAddress("serial:/dev/ttyS0?baud=1200", usual).format.baud, 1200);
}

TEST(LineAddress, WritesWhatItReads) {
  for (const std::string text : {"serial:/dev/ttyS3?baud=9600&bits=8N1", "tcp://host:1", "tcp://[::1]:65535",
                                 "rfc2217://a.b:2001?baud=115200&bits=7O1", "sim:pjlink?fault=busy"}) {
    EXPECT_EQ(parseLineAddress(text).text(), text);
  }
}

TEST(LineAddress, RefusesTheRestAndSaysWhy) {
  EXPECT_THAT(refusal("10.0.0.9:2101"), HasSubstr("\"10.0.0.9:2101\": that is no address of a line; write serial:"));
  EXPECT_THAT(refusal(""), HasSubstr("that is no address"));
  EXPECT_THAT(refusal("tcp://host"), HasSubstr("the port is missing"));
  EXPECT_THAT(refusal("tcp://:5"), HasSubstr("the host is missing"));
  EXPECT_THAT(refusal("tcp://host:0"), HasSubstr("a number from 1 to 65535"));
  EXPECT_THAT(refusal("tcp://host:65536"), HasSubstr("a number from 1 to 65535"));
  EXPECT_THAT(refusal("tcp://host:21x"), HasSubstr("a number from 1 to 65535"));
  EXPECT_THAT(refusal("tcp://fe80::1:21"), HasSubstr("brackets"));
  EXPECT_THAT(refusal("tcp://host:21?baud=9600"), HasSubstr("raw port has no options"));
  EXPECT_THAT(refusal("serial:"), HasSubstr("device file is missing"));
  EXPECT_THAT(refusal("serial:/dev/ttyS0?baud=9601"), HasSubstr("baud is 300"));
  EXPECT_THAT(refusal("serial:/dev/ttyS0?bits=9N1"), HasSubstr("written 8N1"));
  EXPECT_THAT(refusal("serial:/dev/ttyS0?speed=9600"), HasSubstr("no option \"speed=9600\""));
  EXPECT_THAT(refusal("tcp://host:1\n"), HasSubstr("no blanks"));
  EXPECT_THAT(refusal("sim:"), HasSubstr("what is to be simulated is missing"));
  EXPECT_THAT(refusal("tcp://" + std::string(600, 'a') + ":1"), HasSubstr("too long"));
}

// What ser2net says first, and its answer about the speed.
TEST(TelnetCodec, SeparatesCommandsFromDataHoweverItIsCut) {
  const std::string stream = std::string("\xFF\xFB\x03\xFF\xFD\x2C", 6) + "a\xFF\xFF" + "b" +
                             std::string("\xFF\xFA\x2C\x65\x00\x00\x25\x80\xFF\xF0", 10) + "c";
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    TelnetCodec codec;
    TelnetCodec::Decoded all;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      const auto decoded = codec.decode(std::string_view(stream).substr(at, piece));
      all.data += decoded.data;
      all.commands.insert(all.commands.end(), decoded.commands.begin(), decoded.commands.end());
    }
    EXPECT_EQ(all.data,
              "a\xFF"
              "bc");
    ASSERT_EQ(all.commands.size(), 3U);
    EXPECT_EQ(all.commands[0], (TelnetCodec::Command{TelnetCodec::kWill, 3, {}}));
    EXPECT_EQ(all.commands[1], (TelnetCodec::Command{TelnetCodec::kDo, TelnetCodec::kComPort, {}}));
    EXPECT_EQ(all.commands[2],
              (TelnetCodec::Command{0, TelnetCodec::kComPort, std::string("\x65\x00\x00\x25\x80", 5)}));
  }
}

TEST(TelnetCodec, WhatItWritesItReads) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_EQ(TelnetCodec().decode(TelnetCodec::encode(bytes)).data, bytes);
  const auto sub = TelnetCodec().decode(TelnetCodec::subnegotiation(44, std::string("\x01\xFF", 2)));
  ASSERT_EQ(sub.commands.size(), 1U);
  EXPECT_EQ(sub.commands[0].value, std::string("\x01\xFF", 2));
}

TEST(TelnetCodec, AnEndlessSubnegotiationIsBounded) {
  TelnetCodec codec;
  (void)codec.decode("\xFF\xFA\x2C");
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(codec.decode(std::string(1000, 'x')).commands.empty());
  const auto decoded = codec.decode("\xFF\xF0");
  ASSERT_EQ(decoded.commands.size(), 1U);
  EXPECT_LE(decoded.commands[0].value.size(), 256U);
}

}  // namespace
}  // namespace pixelflex::testing
