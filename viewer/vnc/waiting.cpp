#include "viewer/vnc/waiting.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <limits>
#include <system_error>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
int millisecondsUntil(std::optional<Deadline> deadline) {
  if (!deadline) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - std::chrono::steady_clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, std::numeric_limits<int>::max()));
}

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

Signal::Signal() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (event_.get() < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void Signal::raise() {
  // Only a full counter can refuse the write, and then the signal is raised already.
  [[maybe_unused]] const int written = ::eventfd_write(event_.get(), 1);
}

void Signal::clear() {
  eventfd_t count = 0;
  [[maybe_unused]] const int emptied = ::eventfd_read(event_.get(), &count);
}

bool waitFor(int fd, short events, std::optional<Deadline> deadline, const Signal& stop) {
  while (true) {
    std::array<pollfd, 2> watched{{{fd, events, 0}, {stop.fd(), POLLIN, 0}}};
    const int ready = ::poll(watched.data(), watched.size(), millisecondsUntil(deadline));
    if (ready < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "poll");
    if (ready > 0 && watched[1].revents != 0) throw SessionStopped{};
    if (ready > 0) return true;
    if (ready == 0) return false;
  }
}

}  // namespace pixelflex::viewer
