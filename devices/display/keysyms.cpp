#include "devices/display/keysyms.h"

#include <X11/XKBlib.h>
#include <X11/keysym.h>

#include <algorithm>

#include "devices/display/display_error.h"

namespace pixelflex::devices {

struct Keysyms::Connection {
  Display* display = nullptr;
  int keyboardEvents = -1;  // the event number of the keyboard extension
};

namespace {

constexpr unsigned kNumLockMask = Mod2Mask;
constexpr unsigned kThirdLevelMask = Mod5Mask;  // AltGr

}  // namespace

Keysyms::Keysyms() : connection_(std::make_unique<Connection>()) {
  connection_->display = XOpenDisplay(nullptr);
  if (connection_->display == nullptr) throw DisplayError("cannot read the keyboard's layout: the X server is gone");
  XkbQueryExtension(connection_->display, nullptr, &connection_->keyboardEvents, nullptr, nullptr, nullptr);
  XkbSelectEvents(connection_->display, XkbUseCoreKbd, XkbMapNotifyMask, XkbMapNotifyMask);
}

Keysyms::~Keysyms() {
  XCloseDisplay(connection_->display);
}

void Keysyms::followLayout() {
  while (XPending(connection_->display) > 0) {
    XkbEvent event;
    XNextEvent(connection_->display, &event.core);
    if (event.type == connection_->keyboardEvents && event.any.xkb_type == XkbMapNotify) {
      XkbRefreshKeyboardMapping(&event.map);
    } else if (event.type == MappingNotify) {
      XRefreshKeyboardMapping(&event.core.xmapping);
    }
  }
}

unsigned Keysyms::stateOf(KeyModifiers modifiers) const {
  unsigned state = 0;
  if (modifiers.shift) state |= ShiftMask;
  if (modifiers.capsLock) state |= LockMask;
  if (modifiers.numLock) state |= kNumLockMask;
  const bool thirdLevel =
      std::any_of(pressed_.begin(), pressed_.end(), [](const auto& key) { return key.second == XK_ISO_Level3_Shift; });
  if (thirdLevel) state |= kThirdLevelMask;
  XkbStateRec keyboard;
  if (XkbGetState(connection_->display, XkbUseCoreKbd, &keyboard) == Success) {
    state = XkbBuildCoreState(state, keyboard.group);
  }
  return state;
}

std::optional<std::uint32_t> Keysyms::press(int keycode, KeyModifiers modifiers) {
  followLayout();
  unsigned used = 0;
  KeySym keysym = NoSymbol;
  const bool known =
      XkbLookupKeySym(connection_->display, static_cast<KeyCode>(keycode), stateOf(modifiers), &used, &keysym) != False;
  if (!known || keysym == NoSymbol) return {};
  pressed_[keycode] = static_cast<std::uint32_t>(keysym);
  return static_cast<std::uint32_t>(keysym);
}

std::optional<std::uint32_t> Keysyms::release(int keycode) {
  const auto found = pressed_.find(keycode);
  if (found == pressed_.end()) return {};
  const auto keysym = found->second;
  pressed_.erase(found);
  return keysym;
}

std::vector<std::uint32_t> Keysyms::releaseAll() {
  std::vector<std::uint32_t> keysyms;
  keysyms.reserve(pressed_.size());
  for (const auto& [keycode, keysym] : pressed_) keysyms.push_back(keysym);
  pressed_.clear();
  return keysyms;
}

}  // namespace pixelflex::devices
