#include <gmock/gmock.h>

#include <csignal>
#include <iostream>

#include "calib/store/store.h"
#include "tests/e2e/view_lost.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What a process holds.
struct Held {
  std::ptrdiff_t descriptors = 0;
  double kilobytes = 0;  // of resident memory
};

Held heldBy(pid_t pid) {
  const fs::path folder = "/proc/" + std::to_string(pid);
  const std::string status = textOf(folder / "status");
  return {std::distance(fs::directory_iterator(folder / "fd"), fs::directory_iterator()),
          std::stod(status.substr(status.find("VmRSS:") + 6))};
}

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
  Held begin;
  for (std::size_t i = 1; i <= 10; ++i) {
    server->process().signal(SIGKILL);
    server->process().wait(20s);
    waitFor(kLost, i);
    server = startServer();
    const auto returned = Clock::now();
    draw(*server);
    waitFor(kBack, i);
    longest = std::max<std::chrono::duration<double>>(longest, Clock::now() - returned);
    if (i == 2) begin = heldBy(viewer->pid());
  }
  const Held end = heldBy(viewer->pid());
  std::cout << "at most " << longest.count() << " s after the server; resident " << begin.kilobytes << " KiB, then "
            << end.kilobytes << " KiB; " << end.descriptors << " descriptors\n";
  EXPECT_EQ(end.descriptors, begin.descriptors);
  EXPECT_LT(end.kilobytes, begin.kilobytes * 1.02);
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

TEST_F(LostTest, AServerThatStallsIsNoticedWithinTenSeconds) {
  const auto server = startServer();
  const auto viewer = startViewer({"--stats"});
  waitFor("stats:", 1);
  const auto begin = Clock::now();
  server->process().signal(SIGSTOP);
  waitFor(kLost, 1);
  const std::chrono::duration<double> noticed = Clock::now() - begin;
  server->process().signal(SIGCONT);
  const auto returned = Clock::now();
  waitFor(kBack, 1);
  const std::chrono::duration<double> back = Clock::now() - returned;
  std::cout << "noticed after " << noticed.count() << " s, back after " << back.count() << " s\n";
  EXPECT_LT(noticed, 15s);  // ten on a machine that has nothing else to do
  EXPECT_LT(back, 10s);
  EXPECT_THAT(log(), HasSubstr("does not answer any more; waiting"));
}

TEST_F(LostTest, ChangesOfSizeAreFollowed) {
  const auto server = startServer();
  const auto viewer = startViewer({"--stats", "--screenshot", (folder_ / "shot").string(), "--settle", "4000"});
  waitFor("stats:", 1);
  for (const auto* mode : {"1280x720", "640x480", "1920x1080", "800x600"}) {
    server->query({"xrandr", "-s", mode});
    server->query({"xsetroot", "-mod", "5", "7", "-fg", "#336699", "-bg", "#cc9911"});
  }
  ASSERT_EQ(viewer->wait(60s), 0) << log();
  const devices::Image8 expected = grabRoot(server->display());
  ASSERT_EQ(expected.size(), (devices::Size{800, 600}));
  EXPECT_TRUE(devices::readPng8(folder_ / "shot/desktop.png") == expected);
}

TEST_F(LostTest, AServerWithAnotherDesktopIsFollowed) {
  auto server = startServer();
  const auto viewer =
      startViewer({"--retry", "lost", "--stats", "--screenshot", (folder_ / "shot").string(), "--settle", "4000"});
  waitFor("stats:", 1);
  server.reset();
  waitFor(kLost, 1);
  server = startServer("800x600");
  ASSERT_EQ(viewer->wait(60s), 0) << log();
  EXPECT_TRUE(devices::readPng8(folder_ / "shot/desktop.png") == grabRoot(server->display()));
}

/// The mean of all samples of a picture.
double meanOf(const devices::Image8& image) {
  double sum = 0;
  for (const std::uint8_t sample : image.samples()) sum += sample;
  return sum / static_cast<double>(image.samples().size());
}

TEST_F(LostTest, TheLastPictureStaysDimmedOrMarked) {
  XvncServer screen({.size = {640, 240}});
  calib::Wall flat = calib::loadWall(wall());
  for (std::size_t i = 0; i < 2; ++i) {
    flat.projectors[i].output = {
        .kind = calib::OutputKind::kDisplay, .display = screen.x().display(), .at = {static_cast<int>(i) * 320, 0}};
  }
  calib::saveWall(wall(), flat);
  for (const std::string whenLost : {"dim", "mark", "keep"}) {
    SCOPED_TRACE(whenLost);
    auto server = startServer();
    server->query({"xsetroot", "-solid", "#c0c0c0"});
    fs::remove(folder_ / "log");
    const Process viewer({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", wall().string(), "unix:" + socket(),
                          "--when-lost", whenLost, "--view-only", "--source", "vnc"},
                         {.environment = {"DISPLAY=" + screen.x().display()}, .log = folder_ / "log"});
    const auto shown = [&] { return grabRoot(screen.x().display()); };
    const devices::Image8 whole = grabRoot(server->display());
    ASSERT_TRUE(waitUntil([&] { return shown() == whole; })) << log();
    server->process().signal(SIGKILL);
    waitFor(kLost, 1);
    if (whenLost == "dim") {
      EXPECT_TRUE(waitUntil([&] { return meanOf(shown()) < 0.7 * meanOf(whole); }));
      EXPECT_GT(meanOf(shown()), 0.4 * meanOf(whole)) << "still to be read";
    } else if (whenLost == "mark") {
      EXPECT_TRUE(waitUntil([&] { return !(shown() == whole); }));
      EXPECT_NEAR(meanOf(shown()), meanOf(whole), 2) << "a small sign";
    } else {
      EXPECT_TRUE(shown() == whole);
    }
    server = startServer();
    server->query({"xsetroot", "-solid", "#c0c0c0"});
    EXPECT_TRUE(waitUntil([&] { return shown() == whole; })) << "as before once the server is back";
  }
}

}  // namespace
}  // namespace pixelflex::testing
