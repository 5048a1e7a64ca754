#pragma once

#include <cstdint>

#include "viewer/vnc/input_queue.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// A mouse on an X server. The session's thread. The destructor lets go of every button.
class XPointer {
 public:
  /// `connection` must outlive this.
  explicit XPointer(const XConnection& connection);
  ~XPointer();
  XPointer(const XPointer&) = delete;
  XPointer& operator=(const XPointer&) = delete;

  /// A position on the screen and the buttons that are to be down there.
  void set(const PointerInput& pointer);

 private:
  void setButtons(std::uint32_t buttons);

  const XConnection& connection_;
  std::uint32_t buttons_ = 0;
};

}  // namespace pixelflex::viewer
