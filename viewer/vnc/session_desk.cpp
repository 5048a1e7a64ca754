#include "viewer/vnc/session_desk.h"

#include <sys/socket.h>

#include <utility>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {

std::vector<SessionEvent> SessionDesk::takeEvents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

void SessionDesk::add(Input input) {
  if (!takesInput_) return;
  {
    const std::lock_guard lock(mutex_);
    if (!open_) return held_.ignore(input);
    if (!held_.admit(input)) return;
    input_.add(std::move(input));
  }
  inputWaits_.raise();
}

void SessionDesk::stop() {
  stopped_.raise();
  const std::lock_guard lock(mutex_);
  halted_ = true;
  open_ = false;
  // Ends whatever read or write libvncclient is in.
  if (socket_.get() >= 0) ::shutdown(socket_.get(), SHUT_RDWR);
}

int SessionDesk::adopt(FileDescriptor socket) {
  const std::lock_guard lock(mutex_);
  if (halted_) throw SessionStopped{};
  socket_ = std::move(socket);
  return socket_.get();
}

void SessionDesk::open() {
  {
    const std::lock_guard lock(mutex_);
    open_ = !halted_;
    for (Input& release : held_.takeReleases()) input_.add(std::move(release));
  }
  inputWaits_.raise();
}

void SessionDesk::close() {
  const std::lock_guard lock(mutex_);
  if (std::exchange(open_, false)) held_.lose();
  input_ = {};
  const FileDescriptor closed = std::move(socket_);
}

std::vector<Input> SessionDesk::takeInput() {
  // First: what is added from here on raises it again.
  inputWaits_.clear();
  const std::lock_guard lock(mutex_);
  return input_.takeAll();
}

void SessionDesk::post(std::vector<SessionEvent> events) {
  if (events.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    if (halted_) return;
    for (SessionEvent& event : events) appendEvent(events_, std::move(event));
  }
  if (wake_) wake_();
}

}  // namespace pixelflex::viewer
