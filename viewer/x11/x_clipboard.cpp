#include "viewer/x11/x_clipboard.h"

#include <xcb/xcb.h>

namespace pixelflex::viewer {
namespace {

// Never shown; goes with the connection.
std::uint32_t makeWindow(const XConnection& connection) {
  const std::uint32_t window = connection.newId();
  const std::uint32_t events = XCB_EVENT_MASK_PROPERTY_CHANGE;
  xcb_create_window(connection.get(), 0, window, connection.root(), -1, -1, 1, 1, 0, XCB_WINDOW_CLASS_INPUT_ONLY,
                    XCB_COPY_FROM_PARENT, XCB_CW_EVENT_MASK, &events);
  return window;
}

}  // namespace

XClipboard::XClipboard(const XConnection& connection, Selection selection, std::size_t limit)
    : atoms_(connection, selection == Selection::kPrimary ? "PRIMARY" : "CLIPBOARD"),
      window_(makeWindow(connection)),
      reader_(connection, atoms_, window_, limit),
      owner_(connection, atoms_, window_) {}

void XClipboard::handle(const XEvent& event) {
  reader_.handle(event);
  owner_.handle(event);
}

}  // namespace pixelflex::viewer
