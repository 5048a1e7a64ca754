#include "viewer/programs/headless.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <filesystem>
#include <future>
#include <mutex>

#include "devices/display/gl_context.h"
#include "devices/image/png_file.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/stats_printer.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {
namespace {

/// Wakes the render thread from any other.
class Waker {
 public:
  void wake() {
    const std::scoped_lock lock(mutex_);
    woken_ = true;
    changed_.notify_one();
  }
  void waitUntil(WallView::Clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    const auto woken = [this] { return woken_; };
    if (deadline == WallView::Clock::time_point::max()) {
      changed_.wait(lock, woken);
    } else {
      changed_.wait_until(lock, deadline, woken);
    }
    woken_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
};

}  // namespace

int runHeadless(const ViewOptions& options, const WallPlan& wall) {
  Waker waker;
  const QuitSignal quit([&] { waker.wake(); });
  ExpectedPlans plans = expectPlans(wall);
  devices::HeadlessContext context;
  WallView view(options, wall, std::move(plans), context, [&] { waker.wake(); });
  StatsPrinter stats(options);
  while (!quit.raised()) {
    stats.printIfDue(view);
    view.step();
    view.shown();
    stats.shown(view);
    auto deadline = std::min(stats.due(), view.due());
    if (options.screenshot && view.hasPicture()) {
      const auto settled = view.lastChange() + options.settle;
      if (WallView::Clock::now() >= settled) {
        writeScreenshot(*options.screenshot, view.renderer(), options.depth);
        fmt::print("{} projectors and a desktop of {}x{} in {}\n", view.renderer().outputCount(), view.desktop().width,
                   view.desktop().height, *options.screenshot);
        break;
      }
      deadline = std::min(deadline, settled);
    }
    waker.waitUntil(deadline);
  }
  stats.printTotal(view);
  return 0;
}

void writeScreenshot(const std::string& folder, WallRenderer& renderer, int depth) {
  const std::filesystem::path path = folder;
  // Reading back needs this thread's context; compressing does not, and takes longer.
  std::vector<std::future<void>> writing;
  const auto write = [&](const std::string& name, auto image) {
    if (writing.size() >= 2) writing[writing.size() - 2].wait();
    writing.push_back(std::async(
        std::launch::async, [file = path / name, picture = std::move(image)] { devices::writePng(file, picture); }));
  };
  for (std::size_t i = 0; i < renderer.outputCount(); ++i) {
    const auto name = renderer.outputName(i) + ".png";
    if (depth == 10) {
      write(name, renderer.readOutput16(i));
    } else {
      write(name, renderer.readOutput(i));
    }
  }
  write("desktop.png", renderer.readDesktop());
  for (auto& file : writing) file.get();
}

}  // namespace pixelflex::viewer
