#include "viewer/programs/wall_reloader.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "calib/store/store.h"

namespace pixelflex::viewer {
namespace {

// After a change more may follow: what calibrates writes several files.
constexpr int kQuiet = 150;  // milliseconds

bool tellsOfCalibration(std::string_view name) {
  return name == "calibration.yaml" || name == "nudge.yaml";
}

}  // namespace

WallReloader::WallReloader(WatchedWall watched, const WallPlan& shown, std::function<void()> wake)
    : watched_(std::move(watched)), screens_(screensOf(shown)), wake_(std::move(wake)), desktop_(shown.desktop()) {
  watch_ = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  stopped_ = ::eventfd(0, EFD_CLOEXEC);
  constexpr auto kEvents = IN_CLOSE_WRITE | IN_MOVED_TO;
  if (watch_ < 0 || stopped_ < 0 || ::inotify_add_watch(watch_, watched_.folder.c_str(), kEvents) < 0) {
    fmt::print(stderr, "{}: warning: {} cannot be watched: a new calibration is not noticed\n", watched_.program,
               watched_.folder);
    return;
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

WallReloader::~WallReloader() {
  thread_.request_stop();
  if (stopped_ >= 0) ::eventfd_write(stopped_, 1);
  if (thread_.joinable()) thread_.join();
  if (watch_ >= 0) ::close(watch_);
  if (stopped_ >= 0) ::close(stopped_);
}

std::vector<WallReloader::Screen> WallReloader::screensOf(const WallPlan& wall) {
  std::vector<Screen> screens;
  for (const auto* projector : wall.projectors()) screens.push_back({projector->name, projector->resolution});
  return screens;
}

void WallReloader::setDesktop(devices::Size desktop) {
  const std::lock_guard lock(mutex_);
  desktop_ = desktop;
}

std::optional<ReloadedWall> WallReloader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(ready_, std::nullopt);
}

void WallReloader::run(const std::stop_token& stop) {
  constexpr int kForEver = -1;
  while (!stop.stop_requested()) {
    if (!waitForChange(kForEver)) continue;
    while (waitForChange(kQuiet)) {
    }
    if (!stop.stop_requested()) reload();
  }
}

// Milliseconds; true when the calibration was written.
bool WallReloader::waitForChange(int timeout) const {
  std::array<pollfd, 2> watched{{{watch_, POLLIN, 0}, {stopped_, POLLIN, 0}}};
  if (::poll(watched.data(), watched.size(), timeout) <= 0 || watched[1].revents != 0) return false;
  alignas(inotify_event) std::array<char, 4096> buffer{};
  const ssize_t got = ::read(watch_, buffer.data(), buffer.size());
  bool changed = false;
  for (ssize_t at = 0; at < got;) {
    inotify_event event{};
    std::memcpy(&event, &buffer[static_cast<std::size_t>(at)], sizeof event);
    const char* name = &buffer[static_cast<std::size_t>(at) + sizeof event];
    changed |= event.len > 0 && tellsOfCalibration(name);
    at += static_cast<ssize_t>(sizeof event + event.len);
  }
  return changed;
}

void WallReloader::reload() try {
  auto wall =
      std::make_shared<const WallPlan>(watched_.folder, calib::loadWall(watched_.folder),
                                       calib::loadCalibration(watched_.folder), watched_.projectors, watched_.fit);
  if (screensOf(*wall) != screens_) throw std::runtime_error("it has other projectors: start the viewer again");
  devices::Size desktop;
  {
    const std::lock_guard lock(mutex_);
    desktop = desktop_;
  }
  auto plans = watched_.planned ? wall->outputsFor(desktop) : std::vector<OutputPlan>();
  {
    const std::lock_guard lock(mutex_);
    ready_ = ReloadedWall{std::move(wall), desktop, std::move(plans)};
  }
  wake_();
} catch (const std::exception& error) {
  fmt::print(stderr, "{}: the new calibration is not shown: {}\n", watched_.program, error.what());
}

}  // namespace pixelflex::viewer
