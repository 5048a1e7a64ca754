// pixelflex serve as users start it, asked by programs of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/device_room.h"
#include "tests/support/tcp_talk.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ServeTest : public DeviceRoomTest {
 protected:
  void serve(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-serve", folder()});
    program_.emplace(arguments, ProcessOptions{.environment = {}, .log = log()});
  }
  [[nodiscard]] fs::path log() const { return folder_.path() / "serve.log"; }
  [[nodiscard]] static bool eventually(const std::function<bool()>& wanted) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!wanted()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// What it printed behind `label`, to the line's end.
  [[nodiscard]] std::string printed(const std::string& label) const {
    std::string found;
    EXPECT_TRUE(eventually([&] {
      const std::string text = textOf(log());
      const auto at = text.find(label);
      const auto end = at == std::string::npos ? at : text.find('\n', at);
      if (end == std::string::npos) return false;
      found = text.substr(at + label.size(), end - at - label.size());
      return true;
    })) << textOf(log());
    return found;
  }
  [[nodiscard]] std::string file(const std::string& name, const std::string& text, fs::perms mode) const {
    const fs::path path = folder_.path() / name;
    writeText(path, text);
    fs::permissions(path, mode);
    return path.string();
  }
  [[nodiscard]] static Output curl(const std::string& url, std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {"curl", "--silent", "--show-error", "--max-time", "60", "--write-out", " %{http_code}", url});
    return run(more, {}, std::chrono::seconds(90));
  }
  static constexpr auto kPrivate = fs::perms::owner_read | fs::perms::owner_write;

  std::optional<Process> program_;
};

TEST_F(ServeTest, CurlControlsAWall) {
  makeRoom(2);
  serve({"--http", "0", "--name", "Cinema"});
  const std::string at = "http://localhost:" + printed("http://127.0.0.1:");
  EXPECT_THAT(curl(at + "state").text, HasSubstr("\"name\": \"Cinema\""));
  const Output mute = curl(at + "mute", {"--json", R"({"on": true})"});
  EXPECT_THAT(mute.text, HasSubstr(" 202"));
  ASSERT_TRUE(eventually([&] { return projector("p1.control").mute && projector("p2.control").mute; }));
  EXPECT_THAT(printed("pixelflex device"), HasSubstr("p1.control,p2.control mute=on"))
      << "the log tells what was ordered";
  EXPECT_THAT(curl(at + "mute", {"--data", R"({"on": false})"}).text, HasSubstr(" 415")) << "as a form, it is refused";
}

TEST_F(ServeTest, ATokenFileKeepsOthersOut) {
  makeRoom(1);
  const std::string token = "0123456789abcdefghijklmnopqrstuvwxyz";
  serve({"--http", "0.0.0.0:0", "--token-file", file("token", token + "\n", kPrivate)});
  const std::string at = "http://127.0.0.1:" + printed("http://0.0.0.0:");
  EXPECT_THAT(curl(at + "state").text, HasSubstr(" 401"));
  EXPECT_THAT(curl(at + "state", {"--oauth2-bearer", token}).text, HasSubstr(" 200"));
}

TEST_F(ServeTest, RoomControllersFindOneProjector) {
  makeRoom(2);
  serve({"--pjlink", "0"});
  TcpTalk talk(std::stoi(printed("pjlink 127.0.0.1:")));
  EXPECT_EQ(talk.readUntil("\r"), "PJLINK 0\r");
  talk.send("%1INF2 ?\r");
  EXPECT_EQ(talk.readUntil("\r"), "%1INF2=Wall of 2 projectors\r");
}

TEST_F(ServeTest, WhatMovesHaltsWhenItIsKilledAndWhenItEnds) {
  makeRoom(1, 0.02);
  for (const int signal : {SIGKILL, SIGTERM}) {
    fs::remove(log());
    serve({"--http", "0"});
    const std::string at = "http://localhost:" + printed("http://127.0.0.1:");
    EXPECT_THAT(curl(at + "devices/p1", {"--json", signal == SIGKILL ? R"({"pan": 150})" : R"({"pan": -150})"}).text,
                HasSubstr(" 202"));
    ASSERT_TRUE(comesTo(true, "p1.mirror"));
    ASSERT_EQ(::kill(program_->pid(), signal), 0);
    EXPECT_TRUE(comesTo(false, "p1.mirror"));
    EXPECT_LT(std::abs(pan("p1.mirror").position), 2900);
    EXPECT_EQ(program_->wait(std::chrono::seconds(60)), signal == SIGKILL ? 128 + SIGKILL : 0);
  }
}

TEST_F(ServeTest, SaysWhatIsWrong) {
  makeRoom(1);
  const std::string token = file("token", std::string(32, 't'), kPrivate);
  const std::string shared = file("shared", std::string(32, 't'), kPrivate | fs::perms::group_read);
  const std::string brief = file("brief", "secret", kPrivate);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{}, "--http or --pjlink is required"},
      {{"--http", "web"}, "\"web\" is no place to listen at: write PORT for this machine only"},
      {{"--http", "0.0.0.0:0"}, "give --token-file, too"},
      {{"--pjlink", "0.0.0.0:0"}, "give --pjlink-password-file, too"},
      {{"--http", "0", "--token-file", brief}, "a token is 32 or more"},
      {{"--http", "0", "--token-file", shared}, "chmod 600"},
      {{"--http", "0", "--token-file", "/nowhere"}, "no such token file"},
      {{"--http", "8.8.8.8:0", "--token-file", token}, "nothing can listen at 8.8.8.8:0 for HTTP: "}};
  for (const auto& [arguments, message] : cases) {
    std::vector<std::string> all = {folder()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Output output = runProgram("serve", all);
    EXPECT_THAT(output.status, ::testing::AnyOf(1, 2)) << message;
    EXPECT_THAT(output.text, StartsWith("pixelflex-serve: "));
    EXPECT_THAT(output.text, HasSubstr(message));
  }
  EXPECT_THAT(runProgram("serve", {"/nowhere", "--http", "0"}).text, HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace pixelflex::testing
