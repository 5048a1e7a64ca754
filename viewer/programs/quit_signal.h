#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace pixelflex::viewer {

/// Those that end a program: SIGINT, SIGTERM and, unless it is ignored as nohup does, SIGHUP.
[[nodiscard]] sigset_t quitSignals();

/// Turns quitSignals() into a flag and a call. Make it before any
/// other thread: the signals are blocked in every thread that starts later, and a thread of its own waits for them. One
/// at a time.
class QuitSignal {
 public:
  /// `onQuit` is called from that thread.
  explicit QuitSignal(std::function<void()> onQuit);
  ~QuitSignal();
  QuitSignal(const QuitSignal&) = delete;
  QuitSignal& operator=(const QuitSignal&) = delete;
  [[nodiscard]] bool raised() const { return raised_; }

 private:
  std::atomic<bool> raised_ = false;
  std::function<void()> onQuit_;
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
