#include "viewer/control/motion_watchdog.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

#include "devices/transport/line_loop.h"
#include "viewer/control/device_run.h"

namespace pixelflex::viewer {
namespace {

constexpr char kAllStand = '.';
// A port server may need a while to see that the line's last user has gone.
constexpr std::chrono::seconds kPatience{15};

bool saysAllStand(int pipe) {
  char word = 0;
  ssize_t count = 0;
  do {
    count = ::read(pipe, &word, 1);
  } while (count < 0 && errno == EINTR);
  return count == 1 && word == kAllStand;
}

void haltOne(devices::LineLoop& loop, const calib::WallDevice& mirror) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    try {
      return openDevice(loop, mirror, {})->halt();
    } catch (const std::exception&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

/// Out of reach of what ends the other: its signals, its terminal, its descriptors.
[[noreturn]] void watch(int pipe, const std::vector<calib::WallDevice>& mirrors) {
  ::setsid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, descriptor);
  if (saysAllStand(pipe)) ::_exit(0);
  {
    devices::LineLoop loop;
    std::vector<std::jthread> threads;
    for (const auto& mirror : mirrors) threads.emplace_back([&] { haltOne(loop, mirror); });
  }
  ::_exit(0);
}

}  // namespace

MotionWatchdog::MotionWatchdog(const std::vector<calib::WallDevice>& mirrors) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  pipe_ = ends[1];
  child_ = ::fork();
  if (child_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child_ == 0) {
    ::close(ends[1]);
    watch(ends[0], mirrors);
  }
  ::close(ends[0]);
}

MotionWatchdog::~MotionWatchdog() {
  (void)!::write(pipe_, &kAllStand, 1);
  ::close(pipe_);
  ::waitpid(child_, nullptr, 0);
}

}  // namespace pixelflex::viewer
