#include "viewer/x11/cursor_watch.h"

#include <xcb/xcb.h>
#include <xcb/xfixes.h>
#include <xcb/xinput.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "viewer/vnc/rfb_cursor.h"

namespace pixelflex::viewer {
namespace {

struct MotionMask {
  xcb_input_event_mask_t head;
  std::uint32_t mask;
};

std::vector<std::uint8_t> rgbaFromArgb(std::span<const std::uint32_t> pixels) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(pixels.size() * 4);
  for (const std::uint32_t pixel : pixels) {
    for (const int shift : {16, 8, 0, 24}) rgba.push_back(static_cast<std::uint8_t>(pixel >> shift));
  }
  return rgba;
}

}  // namespace

CursorWatch::CursorWatch(const XConnection& connection)
    : connection_(connection),
      cursorEvent_(connection.requireExtension("XFIXES").firstEvent + XCB_XFIXES_CURSOR_NOTIFY) {
  xcb_xfixes_select_cursor_input(connection.get(), connection.root(), XCB_XFIXES_CURSOR_NOTIFY_MASK_DISPLAY_CURSOR);
  watchMotion();
}

// Raw events come wherever the pointer is and whoever has grabbed it.
void CursorWatch::watchMotion() {
  const auto input = connection_.findExtension("XInputExtension");
  if (!input) return;
  xcb_connection_t* x = connection_.get();
  const auto version = connection_.reply<xcb_input_xi_query_version_reply_t>(xcb_input_xi_query_version(x, 2, 2));
  if (version == nullptr || version->major_version < 2) return;
  const MotionMask mask{{XCB_INPUT_DEVICE_ALL_MASTER, 1}, XCB_INPUT_XI_EVENT_MASK_RAW_MOTION};
  xcb_input_xi_select_events(x, connection_.root(), 1, &mask.head);
  inputOpcode_ = input->opcode;
}

void CursorWatch::handle(const XEvent& event) {
  if (event.type() == cursorEvent_) {
    shapeChanged_ = true;
  } else if (event.type() == XCB_GE_GENERIC) {
    const auto& generic = event.as<xcb_ge_generic_event_t>();
    if (generic.extension == inputOpcode_ && generic.event_type == XCB_INPUT_RAW_MOTION) moved_ = true;
  }
}

std::vector<SessionEvent> CursorWatch::takeEvents() {
  std::vector<SessionEvent> events;
  if (std::exchange(shapeChanged_, false)) events.emplace_back(shape());
  if (!std::exchange(moved_, false)) return events;
  const auto found = position();
  if (found && *found != at_) events.emplace_back(at_ = *found);
  return events;
}

CursorShape CursorWatch::shape() const {
  const auto image =
      connection_.reply<xcb_xfixes_get_cursor_image_reply_t>(xcb_xfixes_get_cursor_image(connection_.get()));
  if (image == nullptr) return {};
  const std::span pixels(xcb_xfixes_get_cursor_image_cursor_image(image.get()),
                         static_cast<std::size_t>(xcb_xfixes_get_cursor_image_cursor_image_length(image.get())));
  CursorShape shape = cursorFromPremultiplied({image->width, image->height}, rgbaFromArgb(pixels));
  shape.hotX = image->xhot;
  shape.hotY = image->yhot;
  return shape;
}

std::optional<CursorMoved> CursorWatch::position() const {
  const auto pointer =
      connection_.reply<xcb_query_pointer_reply_t>(xcb_query_pointer(connection_.get(), connection_.root()));
  if (pointer == nullptr || pointer->same_screen == 0) return std::nullopt;
  return CursorMoved{pointer->root_x, pointer->root_y};
}

}  // namespace pixelflex::viewer
