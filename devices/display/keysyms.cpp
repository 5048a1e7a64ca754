#include "devices/display/keysyms.h"

#include <X11/XKBlib.h>
#include <X11/Xlib.h>

#include <utility>

#include "devices/display/display_error.h"

namespace pixelflex::devices {

struct Keysyms::Connection {
  Display* display = nullptr;
  int keyboardEvents = -1;  // the event number of the keyboard extension

  /// NoSymbol when the key means nothing in this layout.
  [[nodiscard]] KeySym keysymOf(const XKeyEvent& event) const {
    unsigned used = 0;
    KeySym keysym = NoSymbol;
    (void)XkbLookupKeySym(display, static_cast<KeyCode>(event.keycode), event.state, &used, &keysym);
    return keysym;
  }
  void follow(XEvent& event) const {
    XkbEvent xkb{};
    xkb.core = event;
    if (event.type == keyboardEvents && xkb.any.xkb_type == XkbMapNotify) {
      XkbRefreshKeyboardMapping(&xkb.map);
    } else if (event.type == MappingNotify) {
      XRefreshKeyboardMapping(&event.xmapping);
    }
  }
};

Keysyms::Keysyms(unsigned long window) : connection_(std::make_unique<Connection>()) {
  Display* const display = connection_->display = XOpenDisplay(nullptr);
  if (display == nullptr) throw DisplayError("cannot read the keyboard's layout: the X server is gone");
  XkbQueryExtension(display, nullptr, &connection_->keyboardEvents, nullptr, nullptr, nullptr);
  XkbSelectEvents(display, XkbUseCoreKbd, XkbMapNotifyMask, XkbMapNotifyMask);
  // A key that is held is then pressed again and again, and released once.
  XkbSetDetectableAutoRepeat(display, True, nullptr);
  XSelectInput(display, window, KeyPressMask | KeyReleaseMask | FocusChangeMask);
  XSync(display, False);
}

Keysyms::~Keysyms() {
  XCloseDisplay(connection_->display);
}

std::vector<KeyStroke> Keysyms::take(bool all) {
  if (all) XSync(connection_->display, False);
  while (XPending(connection_->display) > 0) {
    XEvent event;
    XNextEvent(connection_->display, &event);
    switch (event.type) {
      case KeyPress:
        press(event.xkey.keycode, static_cast<std::uint32_t>(connection_->keysymOf(event.xkey)));
        break;
      case KeyRelease:
        release(event.xkey.keycode);
        break;
      case FocusOut:
        releaseAll();
        break;
      default:
        connection_->follow(event);
    }
  }
  return std::exchange(strokes_, {});
}

void Keysyms::press(unsigned keycode, std::uint32_t keysym) {
  if (keysym == NoSymbol) return;
  const auto [held, isNew] = pressed_.try_emplace(keycode, keysym);
  // Shift pressed while a letter repeats makes another keysym of it.
  if (!isNew && held->second != keysym) {
    strokes_.push_back({std::exchange(held->second, keysym), false});
  }
  strokes_.push_back({keysym, true});
}

void Keysyms::release(unsigned keycode) {
  const auto found = pressed_.find(keycode);
  if (found == pressed_.end()) return;
  strokes_.push_back({found->second, false});
  pressed_.erase(found);
}

void Keysyms::releaseAll() {
  for (const auto& [keycode, keysym] : pressed_) strokes_.push_back({keysym, false});
  pressed_.clear();
}

}  // namespace pixelflex::devices
