#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "viewer/vnc/server_address.h"

namespace pixelflex::viewer {
namespace {

struct Good {
  std::string text;
  ServerAddress address;
};

TEST(ServerAddress, ReadsEveryForm) {
  const Good cases[] = {
      {"wall.example:1", {"wall.example", 5901, ""}},
      {"wall.example", {"wall.example", 5900, ""}},
      {"wall.example::5901", {"wall.example", 5901, ""}},
      {"wall.example::1", {"wall.example", 1, ""}},
      {"10.0.0.7:0", {"10.0.0.7", 5900, ""}},
      {"localhost:99", {"localhost", 5999, ""}},
      {"localhost:123", {"localhost", 6023, ""}},
      {"[::1]:2", {"::1", 5902, ""}},
      {"[fe80::1%eth0]::7000", {"fe80::1%eth0", 7000, ""}},
      {"[2001:db8::5]", {"2001:db8::5", 5900, ""}},
      {"unix:/run/wall.sock", {"", 5900, "/run/wall.sock"}},
      {"unix:a:b c", {"", 5900, "a:b c"}},
      {"x11::7", {"", 5900, "", ":7"}},
      {"x11::7.1", {"", 5900, "", ":7.1"}},
  };
  for (const Good& good : cases) EXPECT_EQ(parseServerAddress(good.text), good.address) << good.text;
}

TEST(ServerAddress, WritesWhatItReads) {
  for (const char* text :
       {"wall:1", "wall::7000", "[::1]:2", "[::1]::80", "unix:/run/w:x.sock", "wall::65535", "x11::7"}) {
    EXPECT_EQ(parseServerAddress(text).text(), text);
  }
  for (const char* text : {"wall", "wall::5901", "wall:4000", "[2001:db8::5]"}) {
    const ServerAddress address = parseServerAddress(text);
    EXPECT_EQ(parseServerAddress(address.text()), address) << text;
  }
}

TEST(ServerAddress, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "the host is missing"},
      {":1", "the host is missing"},
      {"wall:", "the display must be a number"},
      {"wall:x", "the display must be a number"},
      {"wall:-1", "the display must be a number"},
      {"wall:1x", "the display must be a number"},
      {"wall:99999999999", "the display must be a number"},
      {"wall:5901", "a port takes two colons: ::5901"},
      {"wall::", "the port must be a number"},
      {"wall::0", "from 1 to 65535"},
      {"wall::65536", "from 1 to 65535"},
      {"2001:db8::5", "needs brackets"},
      {"::1:0", "needs brackets"},
      {"[::1", "the closing bracket is missing"},
      {"[::1]5", "after the closing bracket"},
      {"[]:1", "the host is missing"},
      {"unix:", "the path of the socket is missing"},
      {"x11:", "the display is missing"},
      {"my wall:1", "no blanks"},
  };
  for (const auto& [text, why] : cases) {
    try {
      (void)parseServerAddress(text);
      ADD_FAILURE() << text << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why)) << text;
      EXPECT_THAT(error.what(), ::testing::HasSubstr("\"" + std::string(text) + "\""));
    }
  }
}

}  // namespace
}  // namespace pixelflex::viewer
