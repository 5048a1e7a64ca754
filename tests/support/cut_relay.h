#pragma once

#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "viewer/vnc/waiting.h"

namespace pixelflex::testing {

/// The network before a server, which can be cut: listens on a port of 127.0.0.1 and hands bytes to the server and
/// back.
class CutRelay {
 public:
  /// `server` is a port of 127.0.0.1. Throws std::runtime_error.
  explicit CutRelay(int server);
  ~CutRelay();
  CutRelay(const CutRelay&) = delete;
  CutRelay& operator=(const CutRelay&) = delete;

  /// As users write it.
  [[nodiscard]] const std::string& address() const { return address_; }

  /// From here on nothing gets through and nobody is told: connections stay open at both ends, and who tries to connect
  /// hears nothing.
  void cut();
  /// New connections get through. Those of before stay dead without a word, as behind a router that has forgotten them.
  void heal();

 private:
  struct Pair {
    viewer::FileDescriptor client;
    viewer::FileDescriptor server;
    bool dead = false;  // open at both ends all the same
  };
  void run(const std::stop_token& stop);
  void accept();
  void forward(Pair& pair);

  const int server_;
  viewer::FileDescriptor listener_;
  std::string address_;
  viewer::Signal woken_;
  std::mutex mutex_;  // guards what follows
  bool cut_ = false;
  std::vector<viewer::FileDescriptor> fillers_;  // of the queue of those who want to connect
  std::vector<Pair> pairs_;
  std::jthread thread_;
};

}  // namespace pixelflex::testing
