#include "devices/display/keysyms.h"

#include <X11/XKBlib.h>
#include <X11/Xlib.h>

#include <utility>

#include "devices/display/display_error.h"
#include "devices/display/key_letters.h"

namespace pixelflex::devices {

struct Keysyms::Connection {
  Display* display = nullptr;
  ::Window window = 0;
  bool grabbed = false;
  int keyboardEvents = -1;  // the event number of the keyboard extension

  /// NoSymbol when the key means nothing in this layout.
  [[nodiscard]] KeySym keysymOf(const XKeyEvent& event) const {
    unsigned used = 0;
    KeySym keysym = NoSymbol;
    (void)XkbLookupKeySym(display, static_cast<KeyCode>(event.keycode), event.state, &used, &keysym);
    return keysym;
  }
  [[nodiscard]] Held held(const XKeyEvent& event) const {
    const auto group = static_cast<unsigned>(XkbGroupForCoreState(event.state));
    const bool shortcut = (event.state & ControlMask) != 0;
    return {static_cast<std::uint32_t>(keysymOf(event)), shortcut ? letterOnKey(display, event.keycode, group) : '\0'};
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
  connection_->window = window;
  // That the server is gone is told by the windows' own connection.
  XSetIOErrorExitHandler(
      display, [](Display* /*x*/, void* /*nothing*/) {}, nullptr);
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
        press(event.xkey.keycode, connection_->held(event.xkey));
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

void Keysyms::press(unsigned keycode, Held now) {
  if (now.keysym == NoSymbol) return;
  const auto [held, isNew] = pressed_.try_emplace(keycode, now);
  // Shift pressed while a letter repeats makes another keysym of it.
  if (!isNew && held->second.keysym != now.keysym) {
    strokes_.push_back({std::exchange(held->second, now).keysym, false, now.letter});
  }
  strokes_.push_back({now.keysym, true, now.letter});
}

void Keysyms::release(unsigned keycode) {
  const auto found = pressed_.find(keycode);
  if (found == pressed_.end()) return;
  strokes_.push_back({found->second.keysym, false, found->second.letter});
  pressed_.erase(found);
}

void Keysyms::releaseAll() {
  for (const auto& [keycode, held] : pressed_) strokes_.push_back({held.keysym, false, held.letter});
  pressed_.clear();
}

int Keysyms::descriptor() const {
  return ConnectionNumber(connection_->display);
}

bool Keysyms::grab() {
  if (connection_->grabbed) return true;
  // Whoever has the keyboard in the same instant, like a window manager whose shortcut ends, has it for a moment only.
  const int answer =
      XGrabKeyboard(connection_->display, connection_->window, True, GrabModeAsync, GrabModeAsync, CurrentTime);
  connection_->grabbed = answer == GrabSuccess;
  return connection_->grabbed;
}

void Keysyms::letGo() {
  if (!std::exchange(connection_->grabbed, false)) return;
  XUngrabKeyboard(connection_->display, CurrentTime);
  XFlush(connection_->display);
  releaseAll();
}

}  // namespace pixelflex::devices
