#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

constexpr int kBandRows = 256;  // the whole of a large screen does not fit into one answer

struct CloseDisplay {
  void operator()(Display* display) const { XCloseDisplay(display); }
};

struct DestroyImage {
  void operator()(XImage* image) const { XDestroyImage(image); }
};

void copyBand(XImage& band, int top, devices::Image8& picture) {
  for (int y = 0; y < band.height; ++y) {
    const auto row = picture.row(top + y);
    for (int x = 0; x < band.width; ++x) {
      const unsigned long pixel = XGetPixel(&band, x, y);
      const auto at = static_cast<std::size_t>(x) * 3;
      row[at] = static_cast<std::uint8_t>(pixel >> 16);
      row[at + 1] = static_cast<std::uint8_t>(pixel >> 8);
      row[at + 2] = static_cast<std::uint8_t>(pixel);
    }
  }
}

}  // namespace

void paintNoise(const std::string& display, unsigned seed) {
  const std::unique_ptr<Display, CloseDisplay> connection(XOpenDisplay(display.c_str()));
  if (connection == nullptr) throw std::runtime_error("cannot open the display " + display);
  Display* x = connection.get();
  const int screen = XDefaultScreen(x);
  const auto width = static_cast<unsigned>(XDisplayWidth(x, screen));
  const auto height = static_cast<unsigned>(XDisplayHeight(x, screen));
  std::mt19937 random(seed);
  std::vector<std::uint32_t> pixels(std::size_t{width} * height);
  std::ranges::generate(pixels, random);
  const std::unique_ptr<XImage, decltype(&XFree)> image(
      XCreateImage(x, XDefaultVisual(x, screen), 24, ZPixmap, 0, reinterpret_cast<char*>(pixels.data()), width, height,
                   32, 0),
      &XFree);
  XPutImage(x, XDefaultRootWindow(x), XDefaultGC(x, screen), image.get(), 0, 0, 0, 0, width, height);
  XSync(x, False);
}

std::size_t keysDown(const std::string& display) {
  const std::unique_ptr<Display, CloseDisplay> connection(XOpenDisplay(display.c_str()));
  if (connection == nullptr) throw std::runtime_error("cannot open the display " + display);
  std::array<char, 32> keys{};  // a bit each
  XQueryKeymap(connection.get(), keys.data());
  std::size_t count = 0;
  for (const char byte : keys) count += static_cast<std::size_t>(std::popcount(static_cast<unsigned char>(byte)));
  return count;
}

devices::Image8 grabRoot(const std::string& display) {
  const std::unique_ptr<Display, CloseDisplay> connection(XOpenDisplay(display.c_str()));
  if (connection == nullptr) throw std::runtime_error("cannot open the display " + display);
  const Window root = XDefaultRootWindow(connection.get());
  XWindowAttributes attributes{};
  XGetWindowAttributes(connection.get(), root, &attributes);
  const Visual& visual = *attributes.visual;
  if (visual.red_mask != 0xff0000 || visual.green_mask != 0xff00 || visual.blue_mask != 0xff) {
    throw std::runtime_error("the display " + display + " has an unusual pixel format");
  }
  devices::Image8 picture({attributes.width, attributes.height}, 3);
  for (int top = 0; top < attributes.height; top += kBandRows) {
    const auto rows = static_cast<unsigned>(std::min(kBandRows, attributes.height - top));
    const std::unique_ptr<XImage, DestroyImage> band(
        XGetImage(connection.get(), root, 0, top, static_cast<unsigned>(attributes.width), rows, AllPlanes, ZPixmap));
    if (band == nullptr) throw std::runtime_error("cannot read the screen of " + display);
    copyBand(*band, top, picture);
  }
  return picture;
}

}  // namespace pixelflex::testing
