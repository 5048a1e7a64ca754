// A wall's remote control over HTTP, against simulated devices behind real TCP ports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "calib/store/store.h"
#include "tests/unit/remote_room.h"

namespace pixelflex::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using viewer::ListenAddress;
using Json = nlohmann::json;

const std::string kToken = "0123456789abcdef0123456789abcdef";

struct Answer {
  int status = 0;
  std::string head;
  Json json;
};

class RemoteHttpTest : public RemoteRoomTest {
 protected:
  void serveHttp(const std::string& token = {}) {
    serve({.name = "The wall", .http = ListenAddress{}, .token = token});
  }
  [[nodiscard]] int port() const { return control_->http()->port; }

  [[nodiscard]] Answer ask(const std::string& method, const std::string& target, const std::string& body = {},
                           const std::string& extra = {}) const {
    const std::string reply = httpExchange(port(), method, target, body, extra);
    const auto gap = std::min(reply.find("\r\n\r\n"), reply.size());
    Answer answer{.status = 0, .head = reply.substr(0, gap), .json = {}};
    if (reply.starts_with("HTTP/1.1 ")) answer.status = std::stoi(reply.substr(9, 3));
    if (gap < reply.size()) answer.json = Json::parse(reply.substr(gap + 4), nullptr, false);
    return answer;
  }
  /// The job's end.
  [[nodiscard]] Json done(const Answer& started) const {
    EXPECT_EQ(started.status, 202) << started.json;
    const std::string place = "/jobs/" + std::to_string(started.json.value("job", 0));
    EXPECT_THAT(started.head, HasSubstr("Location: " + place));
    EXPECT_TRUE(eventually([&] { return ask("GET", place).json["state"] != "running"; }));
    return ask("GET", place).json;
  }
};

TEST_F(RemoteHttpTest, TellsTheWholeWall) {
  makeRoom(2);
  serveHttp();
  const Answer answer = ask("GET", "/state");
  ASSERT_EQ(answer.status, 200);
  EXPECT_THAT(answer.head, HasSubstr("Content-Type: application/json"));
  const Json& wall = answer.json;
  EXPECT_EQ(wall["format"], "pixelflex-state");
  EXPECT_EQ(wall["name"], "The wall");
  EXPECT_EQ(wall["power"], "on");
  EXPECT_EQ(wall["muted"], false);
  EXPECT_EQ(wall["calibration"], nullptr);
  ASSERT_EQ(wall["devices"].size(), 4U);
  EXPECT_EQ(wall["devices"][3]["name"], "p2.mirror");
  EXPECT_EQ(wall["devices"][0]["settings"]["brightness"]["value"], 64);
  EXPECT_EQ(wall["devices"][0]["settings"]["brightness"]["maximum"], 127);
  EXPECT_EQ(wall["devices"][0]["settings"]["power"]["choices"], Json({"on", "off"}));
  EXPECT_THAT(wall["devices"][1]["actions"], Contains("home"));
  EXPECT_EQ(ask("GET", "/devices/p2.mirror").json["settings"]["pan"]["unit"], "deg");
  EXPECT_EQ(ask("GET", "/devices/p9").status, 404);
  EXPECT_EQ(ask("GET", "/jobs/99").status, 404);
}

TEST_F(RemoteHttpTest, SetsDevicesByNameOrInTheWordsOfTheCommandLine) {
  makeRoom(2, 20);
  serveHttp();
  Json job = done(ask("POST", "/devices/p1", R"({"brightness": 80, "mute": true, "pan_counts": 100})"));
  EXPECT_EQ(job["state"], "done") << job;
  EXPECT_EQ(projector("p1.control").brightness, 80);
  EXPECT_TRUE(projector("p1.control").mute);
  EXPECT_FALSE(projector("p2.control").mute);
  EXPECT_EQ(pan("p1.mirror").position, 100);
  // What is done is seen at once.
  EXPECT_EQ(ask("GET", "/devices/p1.control").json["settings"]["brightness"]["value"], 80);
  job = done(ask("POST", "/devices/p1,p2.mirror", R"(["brightness+=5", "pan_counts-=10"])"));
  EXPECT_EQ(job["state"], "done") << job;
  EXPECT_EQ(projector("p1.control").brightness, 85);
  EXPECT_EQ(pan("p2.mirror").position, -10);
}

TEST_F(RemoteHttpTest, WhatMakesNoSenseIsSaidInWords) {
  makeRoom(1);
  serveHttp();
  const auto error = [&](const std::string& method, const std::string& target, const std::string& body, int status) {
    const Answer answer = ask(method, target, body);
    EXPECT_EQ(answer.status, status) << target << " " << body;
    return answer.json.value("error", "");
  };
  EXPECT_THAT(error("POST", "/devices/p9", R"({"mute": true})", 400), HasSubstr("\"p9\" is no device of this wall"));
  EXPECT_THAT(error("POST", "/devices/p1", R"({"Mute ": true})", 400), HasSubstr("write SETTING=VALUE"));
  EXPECT_THAT(error("POST", "/devices/p1", R"({"mute": []})", 400), HasSubstr("a number, a word"));
  EXPECT_THAT(error("POST", "/devices/p1", "{}", 400), HasSubstr("SETTING"));
  EXPECT_THAT(error("POST", "/power", R"({"on": "yes"})", 400), HasSubstr("true or false"));
  EXPECT_THAT(error("POST", "/power", R"({"an": true})", 400), HasSubstr("it may hold on"));
  EXPECT_THAT(error("POST", "/power", R"({"on": tru)", 400), HasSubstr("no JSON"));
  EXPECT_THAT(error("POST", "/halt", std::string(5000, '['), 400), HasSubstr("no JSON"));
  EXPECT_THAT(error("POST", "/presets/none/restore", "{}", 404), HasSubstr("there is no preset \"none\""));
  EXPECT_THAT(error("PUT", "/presets/..%2Fwall", "", 400), HasSubstr("preset"));
  EXPECT_THAT(error("PUT", "/presets/.hidden", "", 400), HasSubstr("preset"));
  EXPECT_THAT(error("DELETE", "/presets/%2e%2e", "", 400), HasSubstr("preset"));
  EXPECT_THAT(error("POST", "/calibrate", R"({"steps": ["--photos"]})", 400), HasSubstr("a name is made of"));
  EXPECT_THAT(error("POST", "/calibrate", R"({"photos": "/etc"})", 400), HasSubstr("it may hold steps"));
  EXPECT_THAT(error("POST", "/calibrate", R"({"steps": ["paint"]})", 400), HasSubstr("is no step"));
  EXPECT_THAT(error("POST", "/freeze", R"({"on": true})", 409), HasSubstr("no projector of this wall"));
  EXPECT_THAT(error("GET", "/etc/passwd", "", 404), HasSubstr("see pixelflex serve --help"));
  EXPECT_THAT(error("GET", "/../wall.yaml", "", 404), HasSubstr("there is no"));
  EXPECT_EQ(error("GET", "/power", "", 405), "this takes POST");
  EXPECT_FALSE(std::filesystem::exists(folder() + "/presets"));
}

TEST_F(RemoteHttpTest, SwitchesAndMutesTheWholeWall) {
  makeRoom(2);
  serveHttp();
  EXPECT_EQ(done(ask("POST", "/mute", R"({"on": true})"))["state"], "done");
  EXPECT_TRUE(projector("p1.control").mute && projector("p2.control").mute);
  EXPECT_EQ(ask("GET", "/state").json["muted"], true);
  EXPECT_EQ(done(ask("POST", "/mute", R"({"on": false})"))["state"], "done");
  EXPECT_EQ(ask("GET", "/state").json["muted"], false);
  for (const auto* control : {"p1.control", "p2.control"}) {
    changeProjector(control, [](auto& state) { state.coolDown = std::chrono::hours(1); });
  }
  const Answer off = ask("POST", "/power", R"({"on": false})");
  EXPECT_EQ(off.json["command"], "pixelflex device " + folder() + " p1.control,p2.control power=off");
  EXPECT_EQ(ask("GET", "/state").json["power"], "cooling") << "also before a projector says so";
  EXPECT_EQ(ask("POST", "/power", R"({"on": false})").json["job"], off.json["job"]) << "ordered twice, done once";
}

TEST_F(RemoteHttpTest, HaltsWhatMoves) {
  makeRoom(1, 0.02);
  serveHttp();
  const Answer move = ask("POST", "/devices/p1", R"({"pan": 150})");
  ASSERT_EQ(move.status, 202);
  ASSERT_TRUE(comesTo(true, "p1.mirror"));
  EXPECT_EQ(done(ask("POST", "/halt"))["state"], "done");
  EXPECT_TRUE(comesTo(false, "p1.mirror"));
  EXPECT_LT(pan("p1.mirror").position, 2900);
  EXPECT_EQ(done(move)["state"], "failed");
}

TEST_F(RemoteHttpTest, SavesPlansRestoresAndDeletesPresets) {
  makeRoom(2, 20);
  serveHttp();
  EXPECT_EQ(done(ask("PUT", "/presets/evening"))["state"], "done");
  ASSERT_TRUE(eventually([&] { return ask("GET", "/presets").json.size() == 1; }));
  EXPECT_EQ(ask("GET", "/presets").json[0]["devices"], 4);
  EXPECT_EQ(done(ask("POST", "/devices/all", R"({"pan_counts": 300})"))["state"], "done");
  const Json plan = done(ask("POST", "/presets/evening/restore", R"({"dry_run": true})"));
  EXPECT_THAT(plan["said"], Contains("move  p2.mirror  pan_counts=0"));
  EXPECT_EQ(pan("p2.mirror").position, 300);
  EXPECT_EQ(ask("GET", "/state").json["preset"], nullptr);
  EXPECT_EQ(done(ask("POST", "/presets/evening/restore"))["state"], "done");
  EXPECT_EQ(pan("p1.mirror").position, 0);
  EXPECT_EQ(ask("GET", "/state").json["preset"], "evening");
  EXPECT_EQ(done(ask("DELETE", "/presets/evening"))["state"], "done");
  EXPECT_FALSE(std::filesystem::exists(folder() + "/presets/evening.yaml"));
  EXPECT_EQ(ask("DELETE", "/presets/evening").status, 404);
}

TEST_F(RemoteHttpTest, CalibratesWithProgressAndCancels) {
  makeRoom(1);
  const auto program = folder_.path() / "pixelflex-calibrate";
  std::ofstream(program) << "#!/bin/sh\necho \"$*\"\necho progress mesh 3 4 p1\nexec sleep 1000\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  serveHttp();
  const Answer started =
      ask("POST", "/calibrate", R"({"steps": ["mesh", "gamma"], "all": true, "only": ["p1"], "method": "dense"})");
  ASSERT_EQ(started.status, 202);
  const std::string place = "/jobs/" + std::to_string(started.json["job"].get<int>());
  ASSERT_TRUE(eventually([&] { return ask("GET", place).json["part"] == 0.75; }));
  EXPECT_THAT(ask("GET", place).json["said"],
              ElementsAre(folder() + " mesh gamma --all --method dense --only p1 --progress"));
  const Answer second = ask("PUT", "/presets/a");
  EXPECT_EQ(second.status, 409);
  EXPECT_THAT(second.json["error"].get<std::string>(), HasSubstr("is still running"));
  EXPECT_EQ(ask("DELETE", place).status, 202);
  EXPECT_THAT(done(started)["error"].get<std::string>(), HasSubstr("stopped on request"));
}

TEST_F(RemoteHttpTest, PagesOfOtherSitesAreRefused) {
  makeRoom(1);
  serveHttp();
  const std::string on = R"({"on": true})";
  const std::string own = "localhost:" + std::to_string(port());
  EXPECT_EQ(ask("POST", "/mute", on, "Content-Type: text/plain\r\n").status, 415);
  EXPECT_EQ(ask("POST", "/mute", on, "Content-Type: application/x-www-form-urlencoded\r\n").status, 415);
  EXPECT_EQ(ask("POST", "/mute", on, "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(ask("POST", "/mute", on, "Origin: null\r\n").status, 403);
  EXPECT_EQ(ask("GET", "/state", "", "Sec-Fetch-Site: cross-site\r\n").status, 403);
  EXPECT_EQ(ask("GET", "/state", "", "Host: evil.example\r\n").status, 421) << "a name that now leads here";
  EXPECT_EQ(ask("GET", "/", "", "Host: evil.example\r\n").status, 421);
  EXPECT_EQ(ask("GET", "/state", "", "Host: localhost.evil.example:80\r\n").status, 421);
  EXPECT_FALSE(projector("p1.control").mute);
  EXPECT_EQ(ask("GET", "/state", "", "Host: 127.0.0.1:1\r\n").status, 200);
  EXPECT_EQ(ask("GET", "/state", "", "Host: [::1]\r\n").status, 200);
  EXPECT_EQ(done(ask("POST", "/mute", on, "Host: " + own + "\r\nOrigin: http://" + own + "\r\n"))["state"], "done");
  EXPECT_TRUE(projector("p1.control").mute);
}

TEST_F(RemoteHttpTest, WithATokenNothingIsToldWithoutIt) {
  makeRoom(1);
  serveHttp(kToken);
  const Answer without = ask("GET", "/state");
  EXPECT_EQ(without.status, 401);
  EXPECT_THAT(without.head, HasSubstr("WWW-Authenticate: Bearer"));
  EXPECT_EQ(ask("GET", "/state", "", "Authorization: Bearer " + kToken.substr(1) + "\r\n").status, 401);
  EXPECT_EQ(ask("GET", "/state", "", "Authorization: Bearer " + kToken + kToken + "\r\n").status, 401);
  EXPECT_EQ(ask("GET", "/state", "", "Authorization: Basic " + kToken + "\r\n").status, 401);
  EXPECT_EQ(ask("POST", "/halt").status, 401);
  EXPECT_EQ(ask("GET", "/nothing").status, 401) << "not even what there is";
  const std::string right = "Authorization: bearer " + kToken + "\r\n";
  EXPECT_EQ(ask("GET", "/state", "", right).status, 200);
  EXPECT_EQ(ask("GET", "/state", "", right + "Host: wall.example\r\n").status, 200);
  EXPECT_EQ(ask("GET", "/state", "", right + "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(ask("GET", "/", "").status, 200) << "the page itself is no secret";
}

TEST_F(RemoteHttpTest, OpensToTheNetworkOnlyWithAToken) {
  makeRoom(1);
  console_.emplace(folder());
  const viewer::RemoteControlOptions open{.http = ListenAddress{.host = "0.0.0.0"}};
  EXPECT_THROW(viewer::RemoteControl(*console_, open), std::invalid_argument);
  EXPECT_THROW(viewer::RemoteControl(*console_, {.http = ListenAddress{}, .token = "short"}), std::invalid_argument);
  EXPECT_NO_THROW(viewer::RemoteControl(*console_, {.http = ListenAddress{.host = "0.0.0.0"}, .token = kToken}));
}

TEST_F(RemoteHttpTest, APortThatIsTakenIsSaid) {
  makeRoom(1);
  serveHttp();
  const viewer::RemoteControlOptions second{.http = control_->http()};
  try {
    const viewer::RemoteControl control(*console_, second);
    FAIL() << "two servers at a port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing can listen at 127.0.0.1:"));
  }
}

TEST_F(RemoteHttpTest, APageIsServedWithAllThatItNeeds) {
  makeRoom(1);
  serveHttp();
  const std::string page = httpExchange(port(), "GET", "/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("Content-Type: text/html"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  EXPECT_THAT(page, HasSubstr("status.js"));
  EXPECT_THAT(httpExchange(port(), "GET", "/status.js"), HasSubstr("Content-Type: text/javascript"));
  EXPECT_THAT(httpExchange(port(), "GET", "/status.css"), HasSubstr("Content-Type: text/css"));
}

TEST_F(RemoteHttpTest, TellsTheLogFromANumberOn) {
  makeRoom(1);
  serveHttp();
  (void)done(ask("POST", "/mute", R"({"on": true})"));
  (void)done(ask("POST", "/mute", R"({"on": false})"));
  const Json log = ask("GET", "/log").json;
  ASSERT_GE(log.size(), 2U);
  const Json& last = log.back();
  EXPECT_THAT(last["text"].get<std::string>(), HasSubstr("mute=off"));
  EXPECT_EQ(last["kind"], "command");
  const Json rest = ask("GET", "/log?after=" + std::to_string(last["number"].get<int>() - 1)).json;
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0], last);
}

}  // namespace
}  // namespace pixelflex::testing
