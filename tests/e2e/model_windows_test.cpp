// pixelflex model in windows on an X server: what they show, and what the hand does to it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "calib/store/store.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using devices::Image8;
using ::testing::HasSubstr;

bool comesTrue(const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

/// Two screens side by side on an X server, which show a tetrahedron.
class ModelWindowsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(runProgram("new", {wall(), "--flat", "2x1:300x200"}).status, 0);
    calib::Wall flat = calib::loadWall(wall());
    for (int i = 0; i < 2; ++i) {
      flat.projectors[static_cast<std::size_t>(i)].output = {
          .kind = calib::OutputKind::kDisplay, .display = screen_.display(), .at = {20 + 300 * i, 30}};
    }
    calib::saveWall(wall(), flat);
    writeText(folder_ / "solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }
  void start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command{std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-model", wall(),
                                     (folder_ / "solid.obj").string(), "--view", "20,20"};
    command.insert(command.end(), more.begin(), more.end());
    viewer_ = std::make_unique<Process>(
        command, ProcessOptions{.environment = {"DISPLAY=" + screen_.display()}, .log = folder_ / "log"});
    ASSERT_TRUE(comesTrue([&] { return litPixels(screens()) > 1000; })) << log();
  }
  /// What both screens show together.
  [[nodiscard]] Image8 screens() const {
    const Image8 root = grabRoot(screen_.display());
    Image8 picture({600, 200}, 3);
    for (int y = 0; y < picture.height(); ++y) {
      std::ranges::copy(root.row(30 + y).subspan(60, 1800), picture.row(y).begin());
    }
    return picture;
  }
  [[nodiscard]] static int litPixels(const Image8& picture) {
    return static_cast<int>(std::ranges::count_if(picture.samples(), [](int code) { return code > 40; }));
  }
  /// In the 300 columns from there on.
  [[nodiscard]] static int litIn(const Image8& picture, int left) {
    int lit = 0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = left; x < left + 300; ++x) lit += picture.at(x, y, 0) > 40 ? 1 : 0;
    }
    return lit;
  }
  [[nodiscard]] bool changesFrom(const Image8& before) const {
    return comesTrue([&] { return !(screens() == before); });
  }
  void hand(std::vector<std::string> command) {
    command.insert(command.begin(), "xdotool");
    screen_.query(command);
  }
  [[nodiscard]] std::string log() const { return textOf(folder_ / "log"); }
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }

  const TemporaryFolder folder_;
  XServer screen_{[](const TemporaryFolder&) {
    return std::vector<std::string>{"Xvfb", "-screen", "0", "700x300x24", "-nolisten", "tcp", "-noreset"};
  }};
  std::unique_ptr<Process> viewer_;
};

TEST_F(ModelWindowsTest, TheHandTurnsMovesAndZoomsTheModelAndEscapeEnds) {
  start();
  Image8 before = screens();
  hand({"mousemove", "200", "100", "mousedown", "1", "mousemove", "260", "120", "mouseup", "1"});
  EXPECT_TRUE(changesFrom(before)) << log();
  before = screens();
  hand({"mousemove", "200", "100", "mousedown", "3", "mousemove", "150", "100", "mouseup", "3"});
  EXPECT_TRUE(changesFrom(before)) << log();
  const int small = litPixels(screens());
  hand({"click", "--repeat", "4", "4"});
  EXPECT_TRUE(comesTrue([&] { return litPixels(screens()) > small * 6 / 5; })) << log();
  before = screens();
  hand({"key", "l"});
  EXPECT_TRUE(changesFrom(before)) << log();
  hand({"key", "Escape"});
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 0) << log();
  EXPECT_THAT(log(), HasSubstr("2 windows"));
}

TEST_F(ModelWindowsTest, NothingIsDrawnWhileNothingChanges) {
  start();
  const auto cpu = [&] {
    std::ifstream stat("/proc/" + std::to_string(viewer_->pid()) + "/stat");
    std::string text((std::istreambuf_iterator<char>(stat)), {});
    std::istringstream words(text.substr(text.rfind(')') + 2));
    std::string word;
    for (int i = 0; i < 11; ++i) words >> word;
    long user = 0;
    long system = 0;
    words >> user >> system;
    return user + system;
  };
  constexpr long kAtRest = 4;  // hundredths of a second
  EXPECT_TRUE(comesTrue([&] {
    const long begin = cpu();
    std::this_thread::sleep_for(std::chrono::seconds(2));
    return cpu() - begin <= kAtRest;
  }));
}

TEST_F(ModelWindowsTest, ANewCalibrationIsShownAtOnce) {
  start();
  Image8 before = screens();
  ASSERT_TRUE(comesTrue([&] {
    // Both windows show their part, which stays.
    const Image8 now = screens();
    const bool rested = now == std::exchange(before, now);
    return rested && litIn(now, 0) > 300 && litIn(now, 300) > 300;
  }));
  auto calibration = calib::loadCalibration(wall());
  ASSERT_EQ(calibration.projectors.size(), 2U);
  std::swap(calibration.projectors[0].samples, calibration.projectors[1].samples);
  std::swap(calibration.projectors[0].model, calibration.projectors[1].model);
  calib::saveCalibration(wall(), calibration);
  // Each screen shows what the other one did; dither makes a code of difference.
  EXPECT_TRUE(comesTrue([&] {
    const Image8 now = screens();
    int different = 0;
    for (int y = 0; y < now.height(); ++y) {
      for (int x = 0; x < now.width(); ++x) {
        different += std::abs(now.at(x, y, 0) - before.at((x + 300) % 600, y, 0)) > 3 ? 1 : 0;
      }
    }
    return different < 100;
  })) << log();
  EXPECT_THAT(log(), HasSubstr("a new calibration is shown"));
  // One that cannot be shown is told of, and the picture stays.
  writeText(folder_ / "wall" / "calibration.yaml", "format: nonsense\n");
  EXPECT_TRUE(comesTrue([&] { return log().find("the new calibration is not shown") != std::string::npos; }));
  EXPECT_GT(litPixels(screens()), 1000);
}

TEST_F(ModelWindowsTest, ASignalEndsIt) {
  start({"--preview"});
  viewer_->signal(SIGTERM);
  EXPECT_EQ(viewer_->wait(std::chrono::seconds(60)), 0) << log();
}

}  // namespace
}  // namespace pixelflex::testing
