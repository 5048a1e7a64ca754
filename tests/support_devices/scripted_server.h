#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace pixelflex::testing {

/// A TCP server on 127.0.0.1 that answers what it is told to, one client at a time. Written with plain sockets.
class ScriptedServer {
 public:
  /// `reply` gets all bytes of one read and returns what to send; "" for nothing. Called on the server's thread.
  explicit ScriptedServer(std::function<std::string(const std::string&)> reply, int port = 0);
  ~ScriptedServer();
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::string address() const { return "tcp://127.0.0.1:" + std::to_string(port_); }
  /// Ends the connection with the client there is.
  void hangUp() { hangUp_ = true; }
  [[nodiscard]] std::string heard() const;
  [[nodiscard]] int clients() const { return clients_; }

 private:
  void serve();
  void talk(int client);

  std::function<std::string(const std::string&)> reply_;
  int socket_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> hangUp_ = false;
  std::atomic<int> clients_ = 0;
  mutable std::mutex mutex_;
  std::string heard_;
  std::thread thread_;
};

}  // namespace pixelflex::testing
