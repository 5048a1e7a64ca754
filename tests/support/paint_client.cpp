#include "tests/support/paint_client.h"

#include <X11/Xlib.h>
#include <poll.h>

#include <chrono>

namespace pixelflex::testing {

PaintClient::PaintClient(const std::string& display) : thread_([this, display] { run(display); }) {
  while (!ready_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

PaintClient::~PaintClient() {
  ready_ = false;
}

std::vector<std::vector<glm::ivec2>> PaintClient::strokes() const {
  const std::scoped_lock lock(mutex_);
  return strokes_;
}

void PaintClient::run(const std::string& display) {
  Display* const x = XOpenDisplay(display.c_str());
  const int screen = DefaultScreen(x);
  XSetWindowAttributes attributes{};
  attributes.override_redirect = True;
  attributes.background_pixel = WhitePixel(x, screen);
  attributes.event_mask = ButtonPressMask | ButtonReleaseMask | Button1MotionMask;
  const Window window = XCreateWindow(x, DefaultRootWindow(x), 0, 0, static_cast<unsigned>(DisplayWidth(x, screen)),
                                      static_cast<unsigned>(DisplayHeight(x, screen)), 0, CopyFromParent, InputOutput,
                                      nullptr, CWOverrideRedirect | CWBackPixel | CWEventMask, &attributes);
  XMapWindow(x, window);
  XSync(x, False);
  ready_ = true;
  const GC pen = DefaultGC(x, screen);
  XSetForeground(x, pen, BlackPixel(x, screen));
  while (ready_) {
    pollfd watched{ConnectionNumber(x), POLLIN, 0};
    if (XPending(x) == 0) ::poll(&watched, 1, 50);
    while (XPending(x) > 0) {
      XEvent event;
      XNextEvent(x, &event);
      const std::scoped_lock lock(mutex_);
      if (event.type == ButtonPress && event.xbutton.button == 1) {
        strokes_.push_back({{event.xbutton.x, event.xbutton.y}});
      } else if (event.type == MotionNotify && !strokes_.empty()) {
        const glm::ivec2 from = strokes_.back().back();
        XDrawLine(x, window, pen, from.x, from.y, event.xmotion.x, event.xmotion.y);
        strokes_.back().push_back({event.xmotion.x, event.xmotion.y});
      }
    }
  }
  XCloseDisplay(x);
}

}  // namespace pixelflex::testing
