// The HTTP server itself against clients that mean harm, are slow or break off; and who is let in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/transport/line_loop.h"
#include "tests/support/tcp_talk.h"
#include "viewer/remote/http_guard.h"
#include "viewer/remote/http_server.h"

namespace pixelflex::testing {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using viewer::HttpReply;
using viewer::HttpRequest;
using viewer::ListenAddress;

class HttpServerTest : public ::testing::Test {
 protected:
  void serve(viewer::HttpServerOptions options = {}) {
    server_.emplace(loop_, options, [](const HttpRequest& request) {
      return HttpReply{.body = request.method + " " + request.target + " " + request.body};
    });
  }
  [[nodiscard]] int port() const { return server_->address().port; }
  [[nodiscard]] std::string say(const std::string& bytes) const {
    TcpTalk talk(port());
    talk.send(bytes);
    return talk.readAll();
  }
  /// Soon.
  [[nodiscard]] bool isWell() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (httpExchange(port(), "GET", "/x").find("GET /x ") == std::string::npos) {
      if (std::chrono::steady_clock::now() > deadline) return false;
    }
    return true;
  }

  devices::LineLoop loop_;
  std::optional<viewer::HttpServer> server_;
};

TEST_F(HttpServerTest, KeepsAConnectionForSeveralRequests) {
  serve();
  TcpTalk talk(port());
  talk.send("GET /a HTTP/1.1\r\nHost: x\r\n\r\nPOST /b HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\nhi");
  EXPECT_THAT(talk.readUntil("GET /a "), StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(talk.readUntil("POST /b hi"), StartsWith("HTTP/1.1 200 OK"));
  talk.send(
      "POST /c HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\nConnection: close\r\n\r\n"
      "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n");
  EXPECT_THAT(talk.readAll(), HasSubstr("POST /c abcde"));
  EXPECT_THAT(say("GET / HTTP/1.0\r\n\r\n"), HasSubstr("GET / ")) << "and closed";
}

TEST_F(HttpServerTest, AHeadHasNoBody) {
  serve();
  const std::string reply = say("HEAD / HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_THAT(reply, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_TRUE(reply.ends_with("\r\n\r\n")) << reply;
}

TEST_F(HttpServerTest, WhatIsTooLongOrNoHttpIsRefusedInWords) {
  serve({.headerBytes = 1024, .bodyBytes = 2048});
  EXPECT_THAT(say("GET /" + std::string(2000, 'x') + " HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(say("GET / HTTP/1.1\r\nA: " + std::string(2000, 'x') + "\r\n\r\n"), StartsWith("HTTP/1.1 431"));
  std::string many = "GET / HTTP/1.1\r\n";
  for (int i = 0; i < 2000; ++i) many += "A" + std::to_string(i) + ": x\r\n";
  EXPECT_THAT(say(many + "\r\n"), StartsWith("HTTP/1.1 431"));
  TcpTalk talk(port());
  talk.send("POST /body HTTP/1.1\r\nContent-Length: 2048\r\n\r\n" + std::string(2048, 'x'));
  EXPECT_THAT(talk.readUntil("POST /body x"), StartsWith("HTTP/1.1 200")) << "longer than a head may be";
  EXPECT_THAT(say("POST / HTTP/1.1\r\nContent-Length: 2049\r\n\r\n" + std::string(2049, 'x')),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(say("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"), StartsWith("HTTP/1.1 4"));
  EXPECT_THAT(say("POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"), StartsWith("HTTP/1.1 4"));
  EXPECT_THAT(say("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFF\r\n" + std::string(100'000, 'x')),
              AnyOf(StartsWith("HTTP/1.1 413"), StartsWith("HTTP/1.1 400")));
  std::string trailers = "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n";
  for (int i = 0; i < 20'000; ++i) trailers += "A: x\r\n";
  EXPECT_THAT(say(trailers), StartsWith("HTTP/1.1 4"));
  EXPECT_THAT(say("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\nabcd"),
              Not(StartsWith("HTTP/1.1 2")));
  for (const std::string& rubbish : {std::string(300, '\0'), std::string("\x16\x03\x01\x02\x00\x01\x00\x01", 8),
                                     std::string("%1POWR ?\r\n\r\n"), std::string("GET / FTP/1.1\r\n\r\n")}) {
    EXPECT_THAT(say(rubbish), StartsWith("HTTP/1.1 400")) << rubbish;
  }
  EXPECT_TRUE(isWell());
}

TEST_F(HttpServerTest, SlowClientsAreGivenUpAndHoldUpNobody) {
  serve({.patience = std::chrono::milliseconds(500)});
  std::vector<std::unique_ptr<TcpTalk>> slow;
  for (int i = 0; i < 20; ++i) {
    slow.push_back(std::make_unique<TcpTalk>(port()));
    slow.back()->send("GET / HTTP/1.1\r\nA");
  }
  EXPECT_TRUE(isWell());
  for (const auto& each : slow) {
    each->send("b");  // a byte now and then does not count
    EXPECT_EQ(each->readAll(), "");
  }
  EXPECT_TRUE(isWell());
}

TEST_F(HttpServerTest, ManyConnectionsAtOnceAreBounded) {
  serve({.connections = 3, .patience = std::chrono::minutes(10)});
  std::vector<std::unique_ptr<TcpTalk>> held;
  for (int i = 0; i < 3; ++i) {
    held.push_back(std::make_unique<TcpTalk>(port()));
    held.back()->send("GET /held HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_THAT(held.back()->readUntil("GET /held "), StartsWith("HTTP/1.1 200"));
  }
  EXPECT_EQ(say("GET /more HTTP/1.1\r\nHost: x\r\n\r\n"), "");
  held.clear();
  EXPECT_TRUE(isWell());
}

TEST_F(HttpServerTest, EndsWithConnectionsOpen) {
  serve();
  TcpTalk idle(port());
  TcpTalk halfway(port());
  idle.send("GET /a HTTP/1.1\r\nHost: x\r\n\r\n");
  (void)idle.readUntil("GET /a ");
  halfway.send("POST /b HTTP/1.1\r\nContent-Length: 100\r\n\r\nx");
  server_.reset();
  EXPECT_EQ(idle.readAll(), "");
  EXPECT_EQ(halfway.readAll(), "");
}

TEST(ListenAddress, ReadsPortsAndAddressesOfThisMachine) {
  EXPECT_EQ(viewer::parseListenAddress("8080"), (ListenAddress{.host = "127.0.0.1", .port = 8080}));
  EXPECT_EQ(viewer::parseListenAddress("localhost:1"), (ListenAddress{.host = "127.0.0.1", .port = 1}));
  EXPECT_EQ(viewer::parseListenAddress("[::1]:80").text(), "[::1]:80");
  EXPECT_TRUE(viewer::parseListenAddress("[::1]:80").isLoopback());
  EXPECT_TRUE(viewer::parseListenAddress("127.1.2.3:80").isLoopback());
  EXPECT_FALSE(viewer::parseListenAddress("0.0.0.0:80").isLoopback());
  EXPECT_FALSE(viewer::parseListenAddress("[::]:80").isLoopback());
  EXPECT_FALSE(viewer::parseListenAddress("[::ffff:10.0.0.1]:80").isLoopback());
  for (const auto* wrong :
       {"", ":", "x", "80x", "65536", "-1", "host:80", "::1:80", "[127.0.0.1]:80", "[::1]", "1.2.3:4", "127.0.0.1:"}) {
    EXPECT_THROW((void)viewer::parseListenAddress(wrong), std::invalid_argument) << wrong;
  }
}

TEST(HttpGuard, SecretsAreTheSameOrNot) {
  EXPECT_TRUE(viewer::isSameSecret("abc", "abc"));
  EXPECT_FALSE(viewer::isSameSecret("abc", "abd"));
  EXPECT_FALSE(viewer::isSameSecret("abc", "ab"));
  EXPECT_FALSE(viewer::isSameSecret("ab", "abc"));
  EXPECT_FALSE(viewer::isSameSecret("abcabc", "abc"));
  EXPECT_FALSE(viewer::isSameSecret("", "abc"));
  EXPECT_FALSE(viewer::isSameSecret("abc", ""));
}

}  // namespace
}  // namespace pixelflex::testing
