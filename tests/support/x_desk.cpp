#include "tests/support/x_desk.h"

#include <X11/XKBlib.h>
#include <X11/Xlib.h>

#include <stdexcept>

namespace pixelflex::testing {
namespace {

Display* open(const std::string& display) {
  Display* const opened = XOpenDisplay(display.c_str());
  if (opened == nullptr) throw std::runtime_error("cannot open display " + display);
  return opened;
}

}  // namespace

XBellWatch::XBellWatch(const std::string& display) : display_(open(display)) {
  XkbSelectEvents(display_, XkbUseCoreKbd, XkbBellNotifyMask, XkbBellNotifyMask);
  XSync(display_, False);
}

XBellWatch::~XBellWatch() {
  XCloseDisplay(display_);
}

bool XBellWatch::rang() {
  bool any = false;
  while (XPending(display_) > 0) {
    XEvent event;
    XNextEvent(display_, &event);  // of no other kind
    any = true;
  }
  return any;
}

void ringBell(const std::string& display) {
  Display* const x = open(display);
  XBell(x, 0);
  XCloseDisplay(x);
}

void hidePointer(const std::string& display) {
  Display* const x = open(display);
  const Window root = DefaultRootWindow(x);
  const char nothing = 0;
  const Pixmap empty = XCreateBitmapFromData(x, root, &nothing, 1, 1);
  XColor black{};
  XDefineCursor(x, root, XCreatePixmapCursor(x, empty, empty, &black, &black, 0, 0));
  XSync(x, False);
  XCloseDisplay(x);
}

}  // namespace pixelflex::testing
