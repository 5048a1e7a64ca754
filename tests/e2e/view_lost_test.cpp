#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

bool waitUntil(const std::function<bool()>& done, std::chrono::seconds timeout = 60s) {
  const auto deadline = Clock::now() + timeout;
  while (!done()) {
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

constexpr const char* kBack = "the desktop is there after";
constexpr const char* kLost = "waiting for it to return";

class LostTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "2x1:320x240"}).status, 0); }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] std::string socket() const { return (folder_ / "vnc.sock").string(); }
  [[nodiscard]] std::string log() const { return textOf(folder_ / "log"); }
  /// Always at the same socket, whatever was there before.
  [[nodiscard]] std::unique_ptr<XServer> startServer(const std::string& geometry = "640x240") const {
    return std::make_unique<XServer>([&](const TemporaryFolder&) {
      return std::vector<std::string>{
          "Xtigervnc", "-geometry", geometry, "-depth",       "24",     "-AlwaysShared",  "-rfbport",
          "-1",        "-nolisten", "tcp",    "-rfbunixpath", socket(), "-SecurityTypes", "None"};
    });
  }
  [[nodiscard]] std::unique_ptr<Process> startViewer(std::vector<std::string> more, const std::string& server = {}) {
    std::vector<std::string> command = {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(),
                                        server.empty() ? "unix:" + socket() : server, "--headless"};
    command.insert(command.end(), more.begin(), more.end());
    return std::make_unique<Process>(command, ProcessOptions{.log = folder_ / "log"});
  }
  void waitFor(const std::string& word, std::size_t times) {
    ASSERT_TRUE(waitUntil([&] { return countOf(log(), word) >= times; })) << "no '" << word << "' in:\n" << log();
  }
  /// Both screens side by side.
  [[nodiscard]] devices::Image8 wallPicture() const {
    const devices::Image8 left = devices::readPng8(folder_ / "shot/p1.png");
    const devices::Image8 right = devices::readPng8(folder_ / "shot/p2.png");
    devices::Image8 whole({left.width() + right.width(), left.height()}, 3);
    for (int y = 0; y < left.height(); ++y) {
      std::ranges::copy(left.row(y), whole.row(y).begin());
      std::ranges::copy(right.row(y), whole.row(y).subspan(std::size_t{3} * 320).begin());
    }
    return whole;
  }
  const TemporaryFolder folder_;
};

void draw(XServer& x) {
  x.start({"bash", "-c", "for i in {1..100000}; do xsetroot -mod $((RANDOM % 14 + 2)) 16 -fg red; done"});
}

TEST_F(LostTest, AServerThatIsKilledTenTimesIsBackEachTimeAndExact) {
  auto server = startServer();
  draw(*server);
  const auto viewer =
      startViewer({"--retry", "lost", "--stats", "--screenshot", (folder_ / "shot").string(), "--settle", "6000"});
  waitFor("stats:", 1);
  std::chrono::duration<double> longest{0};
  for (std::size_t i = 1; i <= 10; ++i) {
    server->process().signal(SIGKILL);
    server->process().wait(20s);
    waitFor(kLost, i);
    server = startServer();
    const auto returned = Clock::now();
    draw(*server);
    waitFor(kBack, i);
    longest = std::max<std::chrono::duration<double>>(longest, Clock::now() - returned);
  }
  std::cout << "at most " << longest.count() << " s after the server\n";
  EXPECT_LT(longest, 5s);  // one second on a machine that has nothing else to do
  EXPECT_EQ(countOf(log(), kLost), 10u) << log();
  EXPECT_EQ(countOf(log(), kBack), 10u) << log();
  server.reset();  // with its client
  server = startServer();
  server->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  ASSERT_EQ(viewer->wait(60s), 0) << log();
  const devices::Image8 expected = grabRoot(server->display());
  EXPECT_TRUE(devices::readPng8(folder_ / "shot/desktop.png") == expected);
  EXPECT_TRUE(wallPicture() == expected) << "exact, so not dimmed any more either";
}

}  // namespace
}  // namespace pixelflex::testing
