#pragma once

#include <memory>
#include <string>

namespace pixelflex::testing {

/// An X client that changes a whole desktop.
class DesktopClient {
 public:
  explicit DesktopClient(const std::string& display);
  ~DesktopClient();
  DesktopClient(const DesktopClient&) = delete;
  DesktopClient& operator=(const DesktopClient&) = delete;

  /// The pointer in wide circles, 60 times a second, by the X server's own hand.
  void movePointer(double seconds);
  /// Every pixel becomes another: waves and noise, as smooth and as rough as photographs.
  void repaint();

 private:
  struct X;
  std::unique_ptr<X> x_;
  int turn_ = 0;
};

}  // namespace pixelflex::testing
