#pragma once

#include <chrono>
#include <optional>
#include <utility>

namespace pixelflex::viewer {

/// Owns a file descriptor. Movable; an empty one holds -1.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor();

  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// An event that another thread can raise and a poll() can wait for. Raising and clearing are thread-safe. Throws
/// std::system_error when the process is out of descriptors.
class Signal {
 public:
  Signal();
  void raise();
  void clear();
  [[nodiscard]] int fd() const { return event_.get(); }

 private:
  FileDescriptor event_;
};

using Deadline = std::chrono::steady_clock::time_point;

/// For poll(): rounded up, never negative; -1, for ever, without a deadline.
[[nodiscard]] int millisecondsUntil(std::optional<Deadline> deadline);

/// Waits until `fd` is ready for `events` (poll()'s) or is in error, and says whether it became so before the deadline;
/// without a deadline it waits for ever. Throws SessionStopped as soon as `stop` is raised.
bool waitFor(int fd, short events, std::optional<Deadline> deadline, const Signal& stop);

}  // namespace pixelflex::viewer
