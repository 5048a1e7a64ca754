#include "tests/support/x_shortcut.h"

#include <X11/Xlib.h>

#include <X11/keysym.h>

#include <stdexcept>

namespace pixelflex::testing {

XShortcut::XShortcut(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
  if (display_ == nullptr) throw std::runtime_error("cannot open display " + display);
  XGrabKey(display_, XKeysymToKeycode(display_, XK_F9), AnyModifier, DefaultRootWindow(display_), True, GrabModeAsync,
           GrabModeAsync);
  XSync(display_, False);
}

XShortcut::~XShortcut() {
  XCloseDisplay(display_);
}

bool XShortcut::used() {
  bool any = false;
  while (XPending(display_) > 0) {
    XEvent event;
    XNextEvent(display_, &event);
    any = any || event.type == KeyPress;
  }
  return any;
}

}  // namespace pixelflex::testing
