#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>

#include "viewer/remote/http_message.h"
#include "viewer/remote/listen_address.h"
#include "viewer/remote/tcp_listener.h"

namespace pixelflex::devices {
class LineLoop;
}

namespace pixelflex::viewer {

struct HttpServerOptions {
  ListenAddress at;
  std::size_t connections = 64;  // at once; more are closed at once
  std::chrono::milliseconds patience{
      15'000};  // for a whole request, also the next one of a connection, and for its reply
  std::size_t headerBytes = 8 * 1024;
  std::size_t bodyBytes = 64 * 1024;
};

/// HTTP/1.1 on a loop's thread.
class HttpServer {
 public:
  /// Called on the loop's thread, so it must not wait for anything.
  using Answer = std::function<HttpReply(const HttpRequest& request)>;

  /// `loop` must outlive it. Throws std::runtime_error when nothing can listen there.
  HttpServer(devices::LineLoop& loop, const HttpServerOptions& options, Answer answer);
  /// Not on the loop's thread. No call of `answer` goes on after it.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// With the port that a 0 became.
  [[nodiscard]] const ListenAddress& address() const { return listener_.address(); }

 private:
  struct Core;
  devices::LineLoop& loop_;
  std::shared_ptr<Core> core_;
  TcpListener listener_;
};

}  // namespace pixelflex::viewer
