#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace pixelflex::devices {

/// The connection to the windowing system: one at a time in a process, made, used and destroyed on the main thread.
/// Windows live shorter than it.
class EventLoop {
 public:
  /// `display`: an X display such as ":0"; none: the environment's. Throws DisplayError when it cannot be reached.
  explicit EventLoop(const std::optional<std::string>& display = std::nullopt);
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// Sleeps until an event, wake() or the timeout, then calls the windows' handlers. What a handler throws comes out
  /// here, and DisplayError when the X server is gone.
  void wait(std::optional<std::chrono::duration<double>> timeout = std::nullopt);
  /// Handles what is there already.
  void poll();

  /// Ends a wait() at once, or the next one. From any thread, while an EventLoop exists.
  static void wake();

  /// `task` is called whenever events have been handled, until it is removed again by its owner. A wait() ends when
  /// `descriptor` has something to read, too.
  void addTask(const void* owner, int descriptor, std::function<void()> task) {
    tasks_[owner] = {descriptor, std::move(task)};
  }
  void removeTask(const void* owner) { tasks_.erase(owner); }

  /// Windows: keeps what a handler threw until the C library has returned.
  void keep(std::exception_ptr thrown) { thrown_ = std::move(thrown); }

 private:
  struct Task {
    int descriptor = -1;
    std::function<void()> run;
  };
  void sleep(std::optional<std::chrono::duration<double>> timeout) const;
  void finish();
  std::map<const void*, Task> tasks_;
  std::exception_ptr thrown_;
};

}  // namespace pixelflex::devices
