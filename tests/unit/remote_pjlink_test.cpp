// A whole wall as one PJLink device, asked byte by byte as JBMIA's specification has it, and by our own driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "calib/store/store.h"
#include "devices/projector_control/device_factory.h"
#include "devices/projector_control/pjlink_search.h"
#include "devices/transport/line_loop.h"
#include "tests/support/udp_talk.h"
#include "tests/unit/remote_room.h"
#include "viewer/remote/pjlink_server.h"

namespace pixelflex::testing {
namespace {

using devices::Fault;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using viewer::ListenAddress;
using viewer::PjlinkSession;

const std::string kPassword = "JBMIAProjectorLink";

/// With the specification's random numbers.
PjlinkSession publishedSession() {
  return {kPassword, [](char, std::string_view body, std::string_view) { return std::string(body) + " heard"; },
          [](std::size_t digits) { return digits == 8 ? "498e4a67" : "3db25e10f69c47a85adb24cf361897e0"; }};
}

TEST(PjlinkSession, LetsInByThePublishedDigests) {
  PjlinkSession md5 = publishedSession();
  EXPECT_EQ(md5.greeting(), "PJLINK 1 498e4a67\r");
  EXPECT_EQ(md5.receive("5d8409bc1c3fa39749434aa3a5c38682%1POWR ?\r"), "%1POWR=POWR heard\r");
  EXPECT_EQ(md5.receive("%1INPT ?\r"), "%1INPT=INPT heard\r") << "only the first command of a connection carries it";
  PjlinkSession sha = publishedSession();
  EXPECT_EQ(sha.receive("PJLINK 2\r"), "PJLINK 2 3db25e10f69c47a85adb24cf361897e0\r");
  EXPECT_EQ(sha.receive("c14b279e603d8a5f17e849ba360f2dc5"
                        "70ab129eac6924d4c129c9c4fcf45be42e1e776325a66db67e5b6eee50f2a692%1POWR ?\r"),
            "%1POWR=POWR heard\r");
}

TEST(PjlinkSession, ShutsOutEverybodyElse) {
  for (const std::string line :
       {"%1POWR ?", "5d8409bc1c3fa39749434aa3a5c38683%1POWR ?", "", "PJLINK 1", "5d8409bc1c3fa39749434aa3a5c3868"}) {
    PjlinkSession session = publishedSession();
    EXPECT_EQ(session.receive(line + "\r%1POWR 0\r"), "PJLINK ERRA\r") << line;
    EXPECT_TRUE(session.wantsClose());
  }
  // Asked for SHA-256, it takes nothing less.
  for (const std::string line : {"5d8409bc1c3fa39749434aa3a5c38682%1POWR ?", "PJLINK 2", "c14b279e",
                                 "c14b279e603d8a5f17e849ba360f2dcX"
                                 "70ab129eac6924d4c129c9c4fcf45be42e1e776325a66db67e5b6eee50f2a692%1POWR ?"}) {
    PjlinkSession session = publishedSession();
    (void)session.receive("PJLINK 2\r");
    EXPECT_EQ(session.receive(line + "\r"), "PJLINK ERRA\r") << line;
  }
}

TEST(PjlinkSession, TakesLinesInPiecesAndInsistsOnNothing) {
  PjlinkSession session("", [](char, std::string_view body, std::string_view value) {
    return std::string(body) + "/" + std::string(value);
  });
  EXPECT_EQ(session.greeting(), "PJLINK 0\r");
  EXPECT_EQ(session.receive("%1po"), "");
  EXPECT_EQ(session.receive("wr ?\r\n%2INNM ?31\r"), "%1POWR=POWR/?\r%2INNM=INNM/?31\r");
  EXPECT_EQ(session.receive("\r\r%\r%1POWR?\rGET / HTTP/1.1\r%1PO R ?\r"), "");
  EXPECT_EQ(session.receive("%1NAME " + std::string(130, 'x') + "\r"), "") << "longer than a command may be";
  EXPECT_FALSE(session.wantsClose());
  EXPECT_EQ(session.receive(std::string(10000, '%')), "");
  EXPECT_TRUE(session.wantsClose());
}

class RemotePjlinkTest : public RemoteRoomTest {
 protected:
  void servePjlink(viewer::RemoteControlOptions options = {}) {
    options.name = "The wall";
    options.version = "1.2.3";
    options.pjlink = ListenAddress{};
    options.pjlinkSearchLatest = std::chrono::milliseconds(5);
    serve(options);
  }
  [[nodiscard]] int port() const { return control_->pjlink()->port; }
  /// The answer's parameter.
  [[nodiscard]] std::string ask(const std::string& command) const {
    TcpTalk talk(port());
    EXPECT_EQ(talk.readUntil("\r"), "PJLINK 0\r");
    talk.send(command + "\r");
    const std::string answer = talk.readUntil("\r");
    EXPECT_EQ(answer.substr(0, 7), command.substr(0, 6) + "=");
    return answer.substr(7, answer.size() - 8);
  }
  [[nodiscard]] bool becomes(const std::string& command, const std::string& answer) const {
    return eventually([&] { return ask(command) == answer; });
  }
};

TEST_F(RemotePjlinkTest, DescribesTheWholeWall) {
  makePjlinkRoom(2);
  saveCalibration(folder(), calib::flatCalibration(calib::loadWall(folder())));
  servePjlink();
  ASSERT_TRUE(becomes("%2RRES ?", "2048x768"));
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"%1CLSS ?", "2"},         {"%1NAME ?", "The wall"},
      {"%1INF1 ?", "PixelFlex"}, {"%1INF2 ?", "Wall of 2 projectors"},
      {"%1INFO ?", ""},          {"%2SVER ?", "1.2.3"},
      {"%1POWR ?", "1"},         {"%1AVMT ?", "30"},
      {"%1ERST ?", "000000"},    {"%1LAMP ?", "1234 1 1234 1"},
      {"%1INST ?", "51"},        {"%2INST ?", "51"},
      {"%1INPT ?", "51"},        {"%2INPT ?", "51"},
      {"%2INNM ?51", "Desktop"}, {"%2IRES ?", "2048x768"},
      {"%2FILT ?", "88"},        {"%2FREZ ?", "0"}};
  for (const auto& [command, answer] : expected) EXPECT_EQ(ask(command), answer) << command;
  EXPECT_THAT(ask("%2SNUM ?"), MatchesRegex("([0-9a-f]{2}:){5}[0-9a-f]{2}"));
}

TEST_F(RemotePjlinkTest, ErrorsAreTheProtocolsOwn) {
  makePjlinkRoom(1);
  servePjlink();
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"%1WHAT ?", "ERR1"},   {"%2POWR ?", "ERR1"},  {"%1FREZ ?", "ERR1"},   {"%3POWR ?", "ERR1"},
      {"%2SVOL 1", "ERR1"},   {"%2MVOL 0", "ERR1"},  {"%2RLMP ?", "ERR1"},   {"%2RFIL ?", "ERR1"},
      {"%1POWR 2", "ERR2"},   {"%1POWR ", "ERR2"},   {"%1POWR 0 1", "ERR2"}, {"%1AVMT 21", "ERR2"},
      {"%1AVMT 12", "ERR2"},  {"%1INPT 31", "ERR2"}, {"%1INPT 41", "ERR2"},  {"%1INPT 5100", "ERR2"},
      {"%2INNM ?99", "ERR2"}, {"%2INNM ?", "ERR2"},  {"%1CLSS 1", "ERR2"},   {"%1ERST 0", "ERR2"},
      {"%2FREZ 2", "ERR2"},   {"%2RRES ?", "ERR3"},  {"%2IRES ?", "*"}};
  for (const auto& [command, answer] : expected) EXPECT_EQ(ask(command), answer) << command;
  EXPECT_TRUE(projector("p1.lamp").isOn());
}

TEST_F(RemotePjlinkTest, SwitchesTheWholeWallOffAndOn) {
  makePjlinkRoom(2);
  const auto both = [&](const std::function<void(devices::ProjectorState&)>& change) {
    for (const auto* lamp : {"p1.lamp", "p2.lamp"}) changeProjector(lamp, change);
  };
  both([](auto& state) { state.coolDown = state.warmUp = std::chrono::hours(1); });
  const auto endWait = [](auto& state) { state.powerChangesAt = {}; };
  servePjlink();
  EXPECT_EQ(ask("%1POWR 0"), "OK");
  EXPECT_EQ(ask("%1POWR ?"), "2") << "at once";
  EXPECT_EQ(ask("%1POWR 0"), "OK") << "impatience does no harm";
  EXPECT_EQ(ask("%1AVMT 31"), "ERR3");
  EXPECT_EQ(ask("%1INPT ?"), "ERR3");
  ASSERT_TRUE(eventually([&] { return projector("p1.lamp").isChanging() && projector("p2.lamp").isChanging(); }));
  both(endWait);
  ASSERT_TRUE(becomes("%1POWR ?", "0"));
  EXPECT_FALSE(projector("p1.lamp").isOn() || projector("p2.lamp").isOn());
  EXPECT_EQ(ask("%2FREZ 1"), "ERR3");
  EXPECT_EQ(ask("%1POWR 1"), "OK");
  EXPECT_EQ(ask("%1POWR ?"), "3");
  ASSERT_TRUE(eventually([&] { return projector("p1.lamp").isChanging() && projector("p2.lamp").isChanging(); }));
  both(endWait);
  ASSERT_TRUE(becomes("%1POWR ?", "1"));
  EXPECT_TRUE(projector("p1.lamp").isOn() && projector("p2.lamp").isOn());
}

TEST_F(RemotePjlinkTest, MutesAndFreezesAllAndSaysSoAtOnce) {
  makePjlinkRoom(2);
  servePjlink();
  EXPECT_EQ(ask("%1AVMT 31"), "OK");
  EXPECT_EQ(ask("%1AVMT ?"), "31");
  ASSERT_TRUE(eventually([&] { return projector("p1.lamp").mute && projector("p2.lamp").mute; }));
  EXPECT_EQ(ask("%1AVMT 30"), "OK");
  EXPECT_EQ(ask("%1AVMT ?"), "30");
  EXPECT_EQ(ask("%1AVMT 11"), "OK");
  EXPECT_EQ(ask("%1AVMT ?"), "11");
  EXPECT_EQ(ask("%2FREZ 1"), "OK");
  EXPECT_EQ(ask("%2FREZ ?"), "1");
  ASSERT_TRUE(eventually([&] { return projector("p1.lamp").freeze && projector("p2.lamp").freeze; }));
}

TEST_F(RemotePjlinkTest, FilesThatCannotBeReadAreAnErrorOfTheProtocol) {
  makePjlinkRoom(1);
  const viewer::WallConsoleOptions looksOnce{.pollEvery = std::chrono::hours(1)};
  console_.emplace(folder(), looksOnce);
  (void)console_->savePreset("a");
  ASSERT_TRUE(comes([](const auto& wall) { return !wall.jobs.back().running; }));
  console_.emplace(folder(), looksOnce);
  ASSERT_TRUE(comes([](const auto& wall) { return !wall.presets.empty(); }));
  control_ =
      std::make_unique<viewer::RemoteControl>(*console_, viewer::RemoteControlOptions{.pjlink = ListenAddress{}});
  const auto loop = std::filesystem::path(folder()) / "presets" / "b.yaml";
  std::filesystem::create_symlink(loop, loop);
  EXPECT_EQ(ask("%1INPT 41"), "ERR3");
  EXPECT_EQ(ask("%1CLSS ?"), "2") << "it goes on";
}

TEST_F(RemotePjlinkTest, PresetsAreItsInputs) {
  makePjlinkRoom(1);
  servePjlink();
  const auto save = [&](const std::string& name) {
    const int job = console_->savePreset(name);
    ASSERT_TRUE(comes([&](const auto& wall) { return !wall.find(job)->running && wall.presets.size() > 0; }));
  };
  save("cinema");
  (void)console_->device("p1.mirror", {"pan_counts=300"});
  ASSERT_TRUE(eventually([&] { return pan("p1.mirror").position == 300; }));
  save("away");
  ASSERT_TRUE(becomes("%1INST ?", "41 42 51"));
  EXPECT_EQ(ask("%2INNM ?41"), "away");
  EXPECT_EQ(ask("%2INNM ?42"), "cinema");
  ASSERT_TRUE(becomes("%1INPT 42", "OK")) << "until the one before has ended";
  EXPECT_EQ(ask("%1INPT ?"), "42");
  ASSERT_TRUE(eventually([&] { return pan("p1.mirror").position == 0; }));
  EXPECT_EQ(ask("%1INPT 51"), "OK") << "the wall as it is";
  EXPECT_EQ(ask("%2INPT ?"), "51");
}

TEST_F(RemotePjlinkTest, TellsTheWorstOfAll) {
  makePjlinkRoom(2);
  servePjlink();
  host_.order("p2.mirror", Fault::kCut);
  ASSERT_TRUE(becomes("%1ERST ?", "000001"));
  host_.order("p1.lamp", Fault::kCut);
  ASSERT_TRUE(becomes("%1ERST ?", "000002"));
  EXPECT_EQ(ask("%1POWR ?"), "1") << "of those that answer";
  host_.heal("p1.lamp");
  host_.heal("p2.mirror");
  ASSERT_TRUE(becomes("%1ERST ?", "000000"));
  changeProjector("p1.lamp", [](auto& state) { state.power = devices::ProjectorState::Power::kOff; });
  ASSERT_TRUE(becomes("%1ERST ?", "000001")) << "partly on";
  EXPECT_EQ(ask("%1POWR ?"), "1");
}

TEST_F(RemotePjlinkTest, OurOwnDriverDrivesIt) {
  makePjlinkRoom(2);
  servePjlink({.pjlinkPassword = kPassword});
  devices::LineLoop loop;
  const auto at = "tcp://" + control_->pjlink()->text();
  const auto wall = devices::makeDevice(loop, {.name = "wall", .driver = "pjlink", .at = at, .password = kPassword});
  EXPECT_EQ(wall->identity(), "PixelFlex Wall of 2 projectors The wall (PJLink class 2)");
  EXPECT_EQ(devices::textOf(wall->read("power")), "on");
  EXPECT_EQ(devices::textOf(wall->read("input")), "network1");
  EXPECT_EQ(devices::textOf(wall->read("hours")), "1234");
  EXPECT_EQ(devices::textOf(wall->read("errors")), "none");
  wall->write("mute", std::string("on"));
  ASSERT_TRUE(eventually([&] { return projector("p1.lamp").mute && projector("p2.lamp").mute; }));
  wall->write("power", std::string("off"));
  EXPECT_FALSE(projector("p1.lamp").isOn() || projector("p2.lamp").isOn());
  const auto stranger = devices::makeDevice(loop, {.name = "stranger", .driver = "pjlink", .at = at, .password = "no"});
  EXPECT_THROW((void)stranger->read("power"), std::runtime_error);
}

TEST_F(RemotePjlinkTest, ServesSeveralAtOnceAndNobodyIsInTheWay) {
  makePjlinkRoom(1);
  servePjlink();
  TcpTalk silent(port());
  TcpTalk halfway(port());
  halfway.send("%1POW");
  TcpTalk garbage(port());
  EXPECT_EQ(garbage.readUntil("\r"), "PJLINK 0\r");
  garbage.send(std::string(5000, '\xFF'));
  EXPECT_EQ(garbage.readAll(), "") << "closed";
  EXPECT_EQ(ask("%1POWR ?"), "1");
  halfway.send("R ?\r");
  EXPECT_EQ(halfway.readUntil("\r"), "PJLINK 0\r");
  EXPECT_EQ(halfway.readUntil("\r"), "%1POWR=1\r");
}

TEST_F(RemotePjlinkTest, IsFoundBySearchAndTellsOfChanges) {
  makePjlinkRoom(1);
  const UdpTalk controller;
  servePjlink({.pjlinkListeners = {{.port = static_cast<std::uint16_t>(controller.port())}}});
  const std::string up = controller.receive();
  EXPECT_THAT(up, MatchesRegex("%2LKUP=([0-9a-f]{2}:){5}[0-9a-f]{2}\r"));
  const UdpTalk searcher;
  searcher.send(port(), "rubbish\r");
  searcher.send(port(), "%2SRCH\r");
  EXPECT_EQ(searcher.receive(), "%2ACKN" + up.substr(6));
  const auto hear = [&](const std::string& text) {
    while (controller.receive() != text) {
    }
  };
  EXPECT_NO_THROW(hear("%2POWR=1\r"));
  EXPECT_EQ(ask("%1POWR 0"), "OK");
  EXPECT_NO_THROW(hear("%2POWR=0\r"));
  host_.order("p1.mirror", Fault::kCut);
  EXPECT_NO_THROW(hear("%2ERST=000001\r"));
}

std::string okTo(char /*itsClass*/, std::string_view /*body*/, std::string_view /*value*/) {
  return "OK";
}

TEST_F(RemotePjlinkTest, OurOwnSearchFindsIt) {
  makePjlinkRoom(1);
  servePjlink();
  std::vector<devices::PjlinkFound> found;
  std::stop_source stop;
  const devices::PjlinkSearch search{.hosts = {"127.0.0.1", "127.0.0.1"},
                                     .port = control_->pjlink()->port,
                                     .patience = std::chrono::seconds(60),
                                     .stop = stop.get_token()};
  devices::searchPjlink(search, [&](const auto& device) {
    found.push_back(device);
    stop.request_stop();
  });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].host, "127.0.0.1");
  EXPECT_EQ(found[0].hardware, ask("%2SNUM ?"));
}

TEST(PjlinkServer, ClosesWhoSaysNothing) {
  devices::LineLoop loop;
  const viewer::PjlinkServer server(loop, {.at = ListenAddress(), .idle = std::chrono::milliseconds(100)}, okTo);
  TcpTalk silent(server.address().port);
  TcpTalk halfway(server.address().port);
  halfway.send("%1POWR");  // is nothing
  EXPECT_EQ(silent.readAll(), "PJLINK 0\r");
  EXPECT_EQ(halfway.readAll(), "PJLINK 0\r");
}

TEST(PjlinkServer, ClosesWhoIsOneTooMany) {
  devices::LineLoop loop;
  const viewer::PjlinkServer server(loop, {.at = ListenAddress(), .connections = 1}, okTo);
  const int port = server.address().port;
  {
    TcpTalk first(port);
    EXPECT_EQ(first.readUntil("\r"), "PJLINK 0\r");
    EXPECT_EQ(TcpTalk(port).readAll(), "");
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::string greeting;
  while (greeting.empty() && std::chrono::steady_clock::now() < deadline) {
    TcpTalk next(port);
    next.send(std::string(5000, '%'));
    greeting = next.readAll();
  }
  EXPECT_EQ(greeting, "PJLINK 0\r") << "there is room again";
}

TEST(PjlinkServer, AWrongPasswordIsToldLateAndEndsTheConnection) {
  devices::LineLoop loop;
  const std::chrono::milliseconds delay(200);
  const viewer::PjlinkServer server(loop, {.at = ListenAddress(), .password = kPassword, .refusalDelay = delay}, okTo);
  TcpTalk talk(server.address().port);
  EXPECT_THAT(talk.readUntil("\r"), MatchesRegex("PJLINK 1 [0-9a-f]{8}\r"));
  const auto begun = std::chrono::steady_clock::now();
  talk.send("%1POWR 0\r%1POWR 0\r");
  EXPECT_EQ(talk.readAll(), "PJLINK ERRA\r");
  EXPECT_GE(std::chrono::steady_clock::now() - begun, delay);
}

}  // namespace
}  // namespace pixelflex::testing
