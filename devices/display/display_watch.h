#pragma once

#include <functional>
#include <memory>

namespace pixelflex::devices {

/// Looks after the environment's X display while a wall is shown on it: the screen saver and the monitors' sleep are
/// held off, and monitors that come and go are told. On a connection and a thread of its own.
class DisplayWatch {
 public:
  /// `onMonitorsChanged` is called from the watch's thread; listMonitors() tells what there is then. Throws
  /// DisplayError.
  explicit DisplayWatch(std::function<void()> onMonitorsChanged);
  ~DisplayWatch();
  DisplayWatch(const DisplayWatch&) = delete;
  DisplayWatch& operator=(const DisplayWatch&) = delete;

  void ringBell();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pixelflex::devices
