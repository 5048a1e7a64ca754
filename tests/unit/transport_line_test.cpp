#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/transport/line.h"
#include "devices/transport/line_loop.h"
#include "tests/support_devices/scripted_server.h"

namespace pixelflex::testing {
namespace {

using devices::Exchange;
using devices::Line;
using devices::LineError;
using devices::LineFailure;
using devices::LineLoop;
using devices::parseLineAddress;
using devices::untilText;
using std::chrono::milliseconds;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kGenerous{20000};

std::string echo(const std::string& bytes) {
  return "<" + bytes + ">";
}

Exchange asking(const std::string& bytes, milliseconds timeout = kGenerous) {
  return {.bytes = bytes, .end = untilText(">"), .timeout = timeout};
}

std::optional<LineFailure> failureOf(Line& line, const Exchange& exchange, std::string* message = nullptr) {
  try {
    (void)line.ask(exchange);
  } catch (const LineError& error) {
    if (message != nullptr) *message = error.what();
    return error.failure();
  }
  return std::nullopt;
}

class LineTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<Line> lineTo(const std::string& address, devices::LineOptions options = {}) {
    options.device = "p1";
    return std::make_unique<Line>(loop_, parseLineAddress(address), options);
  }
  LineLoop loop_;
};

TEST_F(LineTest, AsksAndHearsOverOneConnection) {
  ScriptedServer server(echo);
  const auto line = lineTo(server.address());
  EXPECT_FALSE(line->isConnected());
  EXPECT_EQ(line->ask(asking("one")), "<one>");
  EXPECT_EQ(line->ask(asking("two")), "<two>");
  EXPECT_EQ(line->session(), 1U);
  EXPECT_EQ(server.clients(), 1);
}

TEST_F(LineTest, ADeadPortIsNamedAtOnce) {
  int port = 0;
  { port = ScriptedServer(echo).port(); }
  const auto line = lineTo("tcp://127.0.0.1:" + std::to_string(port));
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x"), &message), LineFailure::kUnreachable);
  EXPECT_EQ(message, "p1 at tcp://127.0.0.1:" + std::to_string(port) + ": no connection: Connection refused");
  // And comes back when something listens there.
  ScriptedServer server(echo, port);
  EXPECT_EQ(line->ask(asking("y")), "<y>");
}

TEST_F(LineTest, ASilentDeviceCostsItsTimeoutAndTheLateReplyIsNotTakenForTheNext) {
  std::atomic<int> requests = 0;
  ScriptedServer server([&](const std::string& bytes) {
    if (++requests > 1) return echo(bytes);
    std::this_thread::sleep_for(milliseconds(150));
    return std::string("<late>");
  });
  const auto line = lineTo(server.address(), {.quiet = milliseconds(1000)});
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x", milliseconds(50)), &message), LineFailure::kSilent);
  EXPECT_THAT(message, HasSubstr("p1 at tcp://127.0.0.1:"));
  EXPECT_THAT(message, HasSubstr("no reply"));
  EXPECT_EQ(line->ask(asking("y")), "<y>");
}

TEST_F(LineTest, AHalfReplyIsToldFromNone) {
  ScriptedServer server([](const std::string& bytes) { return bytes == "x" ? "<half" : echo(bytes); });
  const auto line = lineTo(server.address());
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x", milliseconds(300)), &message), LineFailure::kSilent);
  EXPECT_THAT(message, HasSubstr("cut short"));
  EXPECT_EQ(line->ask(asking("y")), "<y>");
}

TEST_F(LineTest, ALostConnectionIsMadeAgain) {
  ScriptedServer* self = nullptr;
  ScriptedServer server([&](const std::string& bytes) {
    if (bytes == "die") self->hangUp();
    return bytes == "die" ? "" : echo(bytes);
  });
  self = &server;
  const auto line = lineTo(server.address());
  EXPECT_EQ(line->ask(asking("one")), "<one>");
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("die"), &message), LineFailure::kLost);
  EXPECT_THAT(message, HasSubstr("the connection was lost: the other end closed it"));
  EXPECT_EQ(line->ask(asking("two")), "<two>");
  EXPECT_EQ(line->session(), 2U);
}

// A connection may be dead without a word, when a cable was pulled or a firewall has forgotten it.
TEST_F(LineTest, ALastingSilenceIsAnsweredWithANewConnection) {
  std::atomic<bool> dead = true;
  ScriptedServer server([&](const std::string& bytes) { return dead ? "" : echo(bytes); });
  const auto line = lineTo(server.address(), {.quiet = milliseconds(5)});
  for (int i = 0; i < 2; ++i) EXPECT_EQ(failureOf(*line, asking("x", milliseconds(40))), LineFailure::kSilent);
  dead = false;
  EXPECT_EQ(line->ask(asking("y")), "<y>");
  EXPECT_EQ(server.clients(), 2);
}

TEST_F(LineTest, AnUrgentRequestBreaksOffASlowOne) {
  ScriptedServer server([](const std::string& bytes) { return bytes == "slow" ? "" : echo(bytes); });
  const auto line = lineTo(server.address());
  EXPECT_EQ(line->ask(asking("first")), "<first>");
  auto slow = std::async(std::launch::async, [&] { return failureOf(*line, asking("slow")); });
  while (server.heard() != "firstslow") std::this_thread::sleep_for(milliseconds(2));
  auto waiting = std::async(std::launch::async, [&] { return line->ask(asking("after")); });
  EXPECT_EQ(line->ask({.bytes = "halt", .end = untilText(">"), .timeout = kGenerous, .urgent = true}), "<halt>");
  EXPECT_EQ(slow.get(), LineFailure::kInterrupted);
  EXPECT_EQ(waiting.get(), "<after>");
}

TEST_F(LineTest, AGreetingIsKeptForWhoeverAsksForIt) {
  ScriptedServer server([](const std::string& bytes) { return bytes == "x" ? "<x>hello>" : echo(bytes); });
  const auto line = lineTo(server.address());
  EXPECT_EQ(line->ask(asking("x")), "<x>");
  EXPECT_EQ(line->ask({.bytes = "", .end = untilText(">"), .timeout = kGenerous, .keepEarlier = true}), "hello>");
}

TEST_F(LineTest, AFloodIsBounded) {
  ScriptedServer server([](const std::string&) { return std::string(40000, 'x'); });
  const auto line = lineTo(server.address());
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x"), &message), LineFailure::kLost);
  EXPECT_THAT(message, HasSubstr("talks without an end"));
}

TEST_F(LineTest, RequestsKeepTheirDistance) {
  ScriptedServer server(echo);
  const auto line = lineTo(server.address(), {.gap = milliseconds(60)});
  (void)line->ask(asking("0"));
  const auto begun = Clock::now();
  for (int i = 0; i < 3; ++i) (void)line->ask(asking("x"));
  EXPECT_GE(Clock::now() - begun, milliseconds(170));
}

TEST_F(LineTest, TheQueueIsBounded) {
  ScriptedServer server([](const std::string&) { return std::string(); });
  const auto line = lineTo(server.address());
  std::atomic<int> crowded = 0;
  std::atomic<int> interrupted = 0;
  for (int i = 0; i < 80; ++i) {
    line->submit(asking("x"), [&](const Line::Answer& answer) {
      const auto failure = std::get<devices::LineProblem>(answer).failure;
      ++(failure == LineFailure::kCrowded ? crowded : interrupted);
    });
  }
  while (crowded < 16) std::this_thread::sleep_for(milliseconds(2));
  line->disconnect();
  EXPECT_EQ(crowded, 16);
  EXPECT_EQ(interrupted, 64);
}

TEST_F(LineTest, ASimulatorThatDoesNotExistIsRefusedWithWhatThereIs) {
  const auto line = lineTo("sim:toaster");
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x"), &message), LineFailure::kUnreachable);
  EXPECT_THAT(message, HasSubstr("no simulator of \"toaster\", only of ptu"));
}

TEST_F(LineTest, AnInterruptedLineInTheSimulatorIsUnreachable) {
  const auto line = lineTo("sim:ptu?fault=cut");
  std::string message;
  EXPECT_EQ(failureOf(*line, asking("x"), &message), LineFailure::kUnreachable);
  EXPECT_THAT(message, HasSubstr("cut"));
}

// One thread for all: the dead ones must not hold up the others.
TEST_F(LineTest, ThirtyTwoLinesOnOneThreadDoNotStallEachOther) {
  std::vector<std::unique_ptr<ScriptedServer>> servers;
  std::vector<std::unique_ptr<Line>> lines;
  for (int i = 0; i < 32; ++i) {
    const bool dead = i % 4 == 0;
    servers.push_back(std::make_unique<ScriptedServer>(
        [dead](const std::string& bytes) { return dead ? std::string() : echo(bytes); }));
    lines.push_back(lineTo(servers.back()->address()));
  }
  std::atomic<int> answered = 0;
  std::atomic<int> silent = 0;
  for (int round = 0; round < 10; ++round) {
    for (auto& line : lines) {
      line->submit(asking("x"), [&](const Line::Answer& answer) {
        ++(std::holds_alternative<std::string>(answer) ? answered : silent);
      });
    }
  }
  while (answered < 240) std::this_thread::sleep_for(milliseconds(2));
  EXPECT_EQ(silent, 0);  // they wait still, and nobody waited for them
}

}  // namespace
}  // namespace pixelflex::testing
