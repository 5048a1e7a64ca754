// pixelflex desktop: an X desktop of the wall's own size, and nothing left of it afterwards.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>

#include "tests/e2e/view_lost.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

class DesktopTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "2x1:320x240"}).status, 0);
    fs::create_directory(runtime());
    fs::permissions(runtime(), fs::perms::owner_all);
  }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] fs::path shot() const { return folder_ / "shot"; }
  [[nodiscard]] fs::path runtime() const { return folder_ / "run"; }
  [[nodiscard]] std::vector<std::string> environment() const { return {"XDG_RUNTIME_DIR=" + runtime().string()}; }
  [[nodiscard]] std::vector<std::string> command(std::vector<std::string> more) const {
    more.insert(more.begin(), {std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-desktop", wall().string()});
    return more;
  }
  [[nodiscard]] Output desktop(const std::vector<std::string>& more) const {
    return run(command(more), environment(), 120s);
  }
  /// Processes of this test: they have its runtime folder in their environment.
  [[nodiscard]] std::vector<std::string> processes() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      if (!std::isdigit(static_cast<unsigned char>(entry.path().filename().string().front()))) continue;
      if (textOf(entry.path() / "environ").find(environment().front()) == std::string::npos) continue;
      found.push_back(textOf(entry.path() / "comm"));
    }
    return found;
  }
  /// `said`: what the program printed, with the display that it had.
  void expectNothingLeft(const std::string& said) const {
    EXPECT_TRUE(waitUntil([this] { return processes().empty(); }, 20s)) << ::testing::PrintToString(processes());
    EXPECT_TRUE(fs::is_empty(runtime()));
    const auto at = said.find("DISPLAY=:");
    if (at == std::string::npos) return;
    const std::string number = std::to_string(std::stoi(said.substr(at + 9)));
    // Somebody else may have it by now, but not with a lock of a process that is gone.
    const std::string lock = textOf("/tmp/.X" + number + "-lock");
    EXPECT_TRUE(lock.empty() || fs::exists("/proc/" + std::to_string(std::stoi(lock)))) << number;
  }
  const TemporaryFolder folder_;
};

TEST_F(DesktopTest, ShowsItsCommandInTheWallsOwnSize) {
  const Output output = desktop({"--headless", "--screenshot", shot().string(), "--", "xsetroot", "-solid", "#336699"});
  ASSERT_EQ(output.status, 0) << output.text;
  EXPECT_THAT(output.text, HasSubstr("a desktop of 640x240"));
  EXPECT_THAT(output.text, HasSubstr("shown directly"));
  for (const auto* name : {"p1.png", "p2.png"}) {
    const devices::Image8 screen = devices::readPng8(shot() / name);
    EXPECT_EQ(screen.at(0, 0, 0), 0x33) << name;
    EXPECT_EQ(screen.at(319, 239, 2), 0x99) << name;
  }
  EXPECT_EQ(devices::readPng8(shot() / "desktop.png").size(), (devices::Size{640, 240}));
  expectNothingLeft(output.text);
}

TEST_F(DesktopTest, EndsWithItsCommand) {
  const Output output = desktop({"--headless", "--", "xdpyinfo"});
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_THAT(output.text, HasSubstr("640x240 pixels"));
  expectNothingLeft(output.text);
}

TEST_F(DesktopTest, EndsOnSignalsWithAllThatItsCommandStarted) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const fs::path log = folder_ / ("log" + std::to_string(signal));
    Process program(command({"--headless", "--stats", "--", "sh", "-c", "setsid sleep 1000 & exec xlogo"}),
                    {.environment = environment(), .log = log});
    // The desktop, Xvnc, the viewer, xlogo and the sleeper.
    ASSERT_TRUE(waitUntil([&] { return processes().size() >= 5 && countOf(textOf(log), "stats:") > 0; }))
        << textOf(log) << ::testing::PrintToString(processes());
    EXPECT_EQ(fs::status(fs::directory_iterator(runtime())->path()).permissions(), fs::perms::owner_all);
    ::kill(program.pid(), signal);
    EXPECT_EQ(program.wait(30s), 0) << textOf(log);
    expectNothingLeft(textOf(log));
  }
}

TEST_F(DesktopTest, SaysWhatIsWrong) {
  const Output missing = desktop({"--headless", "--", "no-such-program"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.text, HasSubstr("pixelflex-desktop: cannot run no-such-program: No such file"));
  expectNothingLeft(missing.text);
  const Output failing = desktop({"--headless", "--", "sh", "-c", "exit 7"});
  EXPECT_EQ(failing.status, 1);
  EXPECT_THAT(failing.text, HasSubstr("pixelflex-desktop: sh ended at once with status 7"));
  expectNothingLeft(failing.text);
  const Output wrong = desktop({"--headless", "--no-such-option", "--", "xlogo"});
  EXPECT_NE(wrong.status, 0);
  EXPECT_THAT(wrong.text, HasSubstr("--no-such-option"));
  expectNothingLeft(wrong.text);
  auto elsewhere = environment();
  elsewhere.push_back("PATH=" + runtime().string());
  const Output bare = run(command({"--", "xlogo"}), elsewhere);
  EXPECT_EQ(bare.status, 1);
  EXPECT_THAT(bare.text, HasSubstr("apt install tigervnc-standalone-server"));
  fs::remove(wall() / "calibration.yaml");
  const Output raw = desktop({"--", "xlogo"});
  EXPECT_EQ(raw.status, 1);
  EXPECT_THAT(raw.text, HasSubstr("pixelflex calibrate"));
  expectNothingLeft(raw.text);
}

}  // namespace
}  // namespace pixelflex::testing
