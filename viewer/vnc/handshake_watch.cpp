#include "viewer/vnc/handshake_watch.h"

#include <sys/socket.h>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {

HandshakeWatch::HandshakeWatch(int socket, Deadline deadline) {
  thread_ = std::jthread([this, socket, deadline] {
    try {
      waitFor(-1, 0, deadline, done_);
      expired_ = true;
      ::shutdown(socket, SHUT_RDWR);
    } catch (const SessionStopped&) {
      return;  // the handshake is over
    }
  });
}

HandshakeWatch::~HandshakeWatch() {
  done_.raise();
}

}  // namespace pixelflex::viewer
