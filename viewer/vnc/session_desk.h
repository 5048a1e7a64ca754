#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "viewer/vnc/held_input.h"
#include "viewer/vnc/input_queue.h"
#include "viewer/vnc/session_event.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// What a session's owner and its thread hand each other: events one way, input the other, and the socket, so that the
/// owner can end whatever the thread waits for. Thread-safe.
class SessionDesk {
 public:
  /// `wake` is called after each post(), from the session's thread.
  SessionDesk(bool takesInput, std::function<void()> wake) : takesInput_(takesInput), wake_(std::move(wake)) {}

  // The owner's side.
  [[nodiscard]] std::vector<SessionEvent> takeEvents();
  /// Input without a connection is dropped for good.
  void add(Input input);
  /// From here on nothing is taken, and the thread's waits throw SessionStopped.
  void stop();

  // The thread's side.
  /// From here on stop() reaches the socket. Throws SessionStopped.
  int adopt(FileDescriptor socket);
  /// The handshake is done: input is taken, after what lets go of everything that a broken connection left down.
  void open();
  /// Closes the socket, if there is one, and drops the input that was not sent.
  void close();
  /// In order; lowers inputWaits().
  [[nodiscard]] std::vector<Input> takeInput();
  void post(std::vector<SessionEvent> events);
  /// Raised when there is new input.
  [[nodiscard]] const Signal& inputWaits() const { return inputWaits_; }
  [[nodiscard]] const Signal& stopped() const { return stopped_; }

 private:
  const bool takesInput_;
  const std::function<void()> wake_;
  Signal stopped_;
  Signal inputWaits_;
  std::mutex mutex_;  // guards what follows
  bool halted_ = false;
  bool open_ = false;
  FileDescriptor socket_;
  InputQueue input_;
  HeldInput held_;
  std::vector<SessionEvent> events_;
};

}  // namespace pixelflex::viewer
