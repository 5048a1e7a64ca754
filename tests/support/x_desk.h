#pragma once

#include <string>

struct _XDisplay;

namespace pixelflex::testing {

/// Listens to an X server's bell.
class XBellWatch {
 public:
  /// Throws std::runtime_error.
  explicit XBellWatch(const std::string& display);
  ~XBellWatch();
  XBellWatch(const XBellWatch&) = delete;
  XBellWatch& operator=(const XBellWatch&) = delete;

  /// Since the last call.
  bool rang();

 private:
  _XDisplay* display_;
};

void ringBell(const std::string& display);

/// Hides the pointer over the root window as programs do: a cursor without a single pixel.
void hidePointer(const std::string& display);

}  // namespace pixelflex::testing
