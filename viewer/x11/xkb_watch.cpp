#include "viewer/x11/xkb_watch.h"

// A header of C that has a member of this name.
#define explicit explicitMembers
#include <xcb/xkb.h>
#undef explicit

namespace pixelflex::viewer {

XkbWatch::XkbWatch(const XConnection& connection) {
  const auto extension = connection.findExtension("XKEYBOARD");
  if (!extension) return;
  const auto used = connection.reply<xcb_xkb_use_extension_reply_t>(xcb_xkb_use_extension(connection.get(), 1, 0));
  if (used == nullptr || used->supported == 0) return;
  keyboardEvent_ = extension->firstEvent;
  constexpr std::uint16_t kEvents =
      XCB_XKB_EVENT_TYPE_BELL_NOTIFY | XCB_XKB_EVENT_TYPE_MAP_NOTIFY | XCB_XKB_EVENT_TYPE_NEW_KEYBOARD_NOTIFY;
  constexpr std::uint16_t kParts = XCB_XKB_MAP_PART_KEY_SYMS | XCB_XKB_MAP_PART_MODIFIER_MAP;
  xcb_xkb_select_events(connection.get(), XCB_XKB_ID_USE_CORE_KBD, kEvents, 0, kEvents, kParts, kParts, nullptr);
}

void XkbWatch::handle(const XEvent& event) {
  if (event.type() != keyboardEvent_) return;
  const int kind = event.as<xcb_xkb_bell_notify_event_t>().xkbType;  // in the same place in all
  if (kind == XCB_XKB_BELL_NOTIFY) rung_ = true;
  if (kind == XCB_XKB_MAP_NOTIFY || kind == XCB_XKB_NEW_KEYBOARD_NOTIFY) layoutChanged_ = true;
}

}  // namespace pixelflex::viewer
