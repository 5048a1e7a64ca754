#pragma once

#include <functional>
#include <memory>
#include <string>

#include "viewer/remote/listen_address.h"

namespace pixelflex::devices {
class LineLoop;
}

namespace pixelflex::viewer {

/// Accepts TCP connections on a loop's thread.
class TcpListener {
 public:
  /// Called on the loop's thread with the descriptor of a connection, which is then its receiver's.
  using Take = std::function<void(int descriptor)>;

  /// `loop` must outlive it; `protocol` is named in messages. Throws std::runtime_error when nothing can listen there.
  TcpListener(devices::LineLoop& loop, const ListenAddress& at, const std::string& protocol, Take take);
  /// No call of `take` goes on after it.
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// With the port that a 0 became.
  [[nodiscard]] const ListenAddress& address() const { return address_; }

 private:
  struct Core;
  devices::LineLoop& loop_;
  std::shared_ptr<Core> core_;
  ListenAddress address_;
};

}  // namespace pixelflex::viewer
