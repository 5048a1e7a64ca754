#include "tests/bench/desktop_client.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pixelflex::testing {
namespace {

constexpr unsigned kTile = 509;

std::vector<std::uint32_t> tilePixels(int turn) {
  std::vector<std::uint32_t> pixels(std::size_t{kTile} * kTile);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double u = static_cast<double>(i % kTile) / kTile;
    const double v = static_cast<double>(i / kTile) / kTile;
    const double light = 120 + 60 * std::sin(40 * u + turn) * std::sin(30 * v) + static_cast<double>(i * 7919 % 13);
    const auto grey = static_cast<std::uint32_t>(light);
    pixels[i] = grey << 16 | (grey * 3 / 4) << 8 | (255 - grey);
  }
  return pixels;
}

}  // namespace

struct DesktopClient::X {
  Display* display = nullptr;
  int screen = 0;
  Window root = 0;
  int width = 0;
  int height = 0;
};

DesktopClient::DesktopClient(const std::string& display) : x_(std::make_unique<X>()) {
  x_->display = XOpenDisplay(display.c_str());
  if (x_->display == nullptr) throw std::runtime_error("cannot open the display " + display);
  x_->screen = XDefaultScreen(x_->display);
  x_->root = XDefaultRootWindow(x_->display);
  x_->width = XDisplayWidth(x_->display, x_->screen);
  x_->height = XDisplayHeight(x_->display, x_->screen);
}

DesktopClient::~DesktopClient() {
  XCloseDisplay(x_->display);
}

void DesktopClient::movePointer(double seconds) {
  constexpr std::chrono::microseconds kPeriod{16667};
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
    const double angle = 0.02 * i;
    XWarpPointer(x_->display, None, x_->root, 0, 0, 0, 0, static_cast<int>(x_->width * (0.5 + 0.45 * std::cos(angle))),
                 static_cast<int>(x_->height * (0.5 + 0.45 * std::sin(1.7 * angle))));
    XFlush(x_->display);
    std::this_thread::sleep_until(next += kPeriod);
  }
}

void DesktopClient::repaint() {
  auto pixels = tilePixels(++turn_);
  Display* const x = x_->display;
  const std::unique_ptr<XImage, decltype(&XFree)> image(
      XCreateImage(x, XDefaultVisual(x, x_->screen), 24, ZPixmap, 0, reinterpret_cast<char*>(pixels.data()), kTile,
                   kTile, 32, 0),
      &XFree);
  XGCValues values{};
  values.fill_style = FillTiled;
  values.tile = XCreatePixmap(x, x_->root, kTile, kTile, 24);
  XPutImage(x, values.tile, XDefaultGC(x, x_->screen), image.get(), 0, 0, 0, 0, kTile, kTile);
  GC pen = XCreateGC(x, x_->root, GCFillStyle | GCTile, &values);
  XFillRectangle(x, x_->root, pen, 0, 0, static_cast<unsigned>(x_->width), static_cast<unsigned>(x_->height));
  XFreeGC(x, pen);
  XFreePixmap(x, values.tile);
  XSync(x, False);
}

}  // namespace pixelflex::testing
