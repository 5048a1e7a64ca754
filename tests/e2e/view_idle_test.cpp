#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <thread>

#include "tests/e2e/mini_wall.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;

/// User and system time of a process, in seconds.
double cpuSeconds(pid_t pid) {
  std::istringstream stat(textOf("/proc/" + std::to_string(pid) + "/stat"));
  std::string field;
  double ticks = 0;
  for (int i = 1; i <= 15 && stat >> field; ++i) {
    if (i >= 14) ticks += std::stod(field);
  }
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// Nothing changes on the desktop for ten seconds: nothing is uploaded or drawn, and next to no time is used.
void expectIdle(const std::string& wall, const std::string& address, std::vector<std::string> more,
                const ProcessOptions& options) {
  std::vector<std::string> command = {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall, address, "--stats"};
  command.insert(command.end(), more.begin(), more.end());
  Process viewer(command, options);
  // Wait for the first picture and for what follows it to end: two seconds without a new line.
  std::string before;
  for (int i = 0; i < 30; ++i) {
    std::this_thread::sleep_for(2s);
    const std::string now = textOf(options.log);
    if (!now.empty() && now == before) break;
    before = now;
  }
  ASSERT_THAT(before, ::testing::HasSubstr("outputs drawn"));
  const double cpu = cpuSeconds(viewer.pid());
  std::this_thread::sleep_for(10s);
  const double used = cpuSeconds(viewer.pid()) - cpu;
  EXPECT_LT(used, 0.2);  // 2 % of a core
  std::cout << "10 s idle: " << used * 1000 << " ms of processor time\n";
  EXPECT_EQ(countOf(textOf(options.log), "stats:"), countOf(before, "stats:"));
  viewer.signal(SIGTERM);
  EXPECT_EQ(viewer.wait(60s), 0);
}

TEST(ViewIdle, AHeadlessWallSleeps) {
  const TemporaryFolder folder;
  XvncServer server({.size = {1280, 960}});
  ASSERT_EQ(runProgram("new", {(folder / "wall").string(), "--flat", "2x2:640x480"}).status, 0);
  expectIdle((folder / "wall").string(), server.unixAddress(), {"--headless"}, {.log = folder / "log"});
}

TEST(ViewIdle, AWallInWindowsSleeps) {
  const TemporaryFolder folder;
  XvncServer server({.size = {1280, 480}});
  const std::string wall = (folder / "wall").string();
  makeMiniWall(wall);
  X11vncServer room({1500, 1000});
  expectIdle(wall, server.unixAddress(), {}, {.environment = {"DISPLAY=" + room.x().display()}, .log = folder / "log"});
}

}  // namespace
}  // namespace pixelflex::testing
