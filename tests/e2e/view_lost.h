#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {

[[nodiscard]] inline std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// Asks every few milliseconds; false when it has not come true in time.
inline bool waitUntil(const std::function<bool()>& done, std::chrono::seconds timeout = std::chrono::seconds(60)) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!done()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

inline constexpr const char* kBack = "the desktop is there after";
inline constexpr const char* kLost = "waiting for it to return";

/// A headless viewer of two screens side by side, and a server that comes and goes at the same place.
class LostTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "2x1:320x240"}).status, 0); }
  [[nodiscard]] std::filesystem::path wall() const { return folder_ / "wall"; }
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
    // Of this machine's Xvnc the X server would be taken.
    if (std::ranges::find(more, "--source") == more.end()) more.insert(more.end(), {"--source", "vnc"});
    command.insert(command.end(), more.begin(), more.end());
    std::filesystem::remove(folder_ / "log");
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

}  // namespace pixelflex::testing
