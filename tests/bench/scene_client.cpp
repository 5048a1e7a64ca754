// An X client that keeps a desktop busy in one way, until it is killed: see kScenes.
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "devices/image/photo_file.h"

namespace {

using pixelflex::devices::Image8;

constexpr const char* kScenes =
    "usage: scene_client photographs|video|drag FOLDER\n"
    "photographs: eight photographs of FOLDER slide over the desktop\n"
    "video: a window of 1280x720 pixels changes whole, 30 times a second\n"
    "drag: a window full of text is dragged over a patterned desktop\n";
constexpr std::chrono::milliseconds kFrame{33};

struct CloseDisplay {
  void operator()(Display* display) const { XCloseDisplay(display); }
};

class Scene {
 public:
  Scene() : connection_(XOpenDisplay(nullptr)) {
    if (connection_ == nullptr) throw std::runtime_error("cannot open the display");
    screen_ = XDefaultScreen(x());
    width_ = XDisplayWidth(x(), screen_);
    height_ = XDisplayHeight(x(), screen_);
  }

  void slidePhotographs(const std::string& folder) {
    std::vector<Window> windows;
    std::vector<Pixmap> pixmaps;
    for (const char* name : {"fruits", "baboon", "home", "starry_night", "aloeL", "stuff", "board", "leuvenA"}) {
      const Image8 photo = pixelflex::devices::readPhoto(folder + "/" + name + ".jpg");
      const auto i = static_cast<int>(windows.size());
      windows.push_back(window(i % 4 * width_ / 4, i / 4 * height_ / 2, width_ / 4 - 40, height_ / 2 - 60));
      pixmaps.push_back(pixmap(photo));
    }
    for (int step = 0;; ++step) {
      for (std::size_t i = 0; i < windows.size(); ++i) tile(windows[i], pixmaps[i], 7 * step, 3 * step);
      pause();
    }
  }

  void playVideo(const std::string& folder) {
    const Image8 photo = pixelflex::devices::readPhoto(folder + "/starry_night.jpg");
    const Window target = window(width_ / 3, height_ / 3, 1280, 720);
    for (int step = 0;; ++step) {
      put(target, 1280, 720, [&](int x, int y) {
        const double zoom = 1.2 + 0.5 * std::sin(0.05 * step);
        const auto at = [&](double value, int size) { return static_cast<int>(std::abs(value)) % size; };
        const int column = at(x / zoom + 5 * step, photo.width());
        const int row = at(y / zoom + 40 * std::sin(0.01 * x + 0.1 * step), photo.height());
        return colour(photo, column, row);
      });
      pause();
    }
  }

  void dragWindow() {
    put(XDefaultRootWindow(x()), width_, height_, [](int x, int y) {
      return (static_cast<std::uint32_t>(x / 8) * 0x010101U + static_cast<std::uint32_t>(y / 32) * 0x000300U) &
             0xffffffU;
    });
    const Window target = window(0, 0, 900, 700);
    GC gc = XCreateGC(x(), target, 0, nullptr);
    for (int step = 0;; ++step) {
      const double angle = 0.04 * step;
      XMoveWindow(x(), target, static_cast<int>((width_ - 900) * (0.5 + 0.5 * std::cos(angle))),
                  static_cast<int>((height_ - 700) * (0.5 + 0.5 * std::sin(1.3 * angle))));
      for (int line = 0; step % 30 == 0 && line < 45; ++line) {
        const std::string text = "line " + std::to_string(line) + " of page " + std::to_string(step / 30) +
                                 ": a window full of text, as editors and terminals have it, for the eyes to read.";
        XDrawImageString(x(), target, gc, 10, 15 * (line + 1), text.c_str(), static_cast<int>(text.size()));
      }
      pause();
    }
  }

 private:
  [[nodiscard]] Display* x() const { return connection_.get(); }

  static std::uint32_t colour(const Image8& photo, int column, int row) {
    return static_cast<std::uint32_t>(photo.at(column, row, 0) << 16 | photo.at(column, row, 1) << 8 |
                                      photo.at(column, row, 2));
  }

  [[nodiscard]] Window window(int left, int top, int width, int height) {
    XSetWindowAttributes attributes{};
    attributes.override_redirect = True;
    attributes.background_pixel = XWhitePixel(x(), screen_);
    const Window window = XCreateWindow(x(), XDefaultRootWindow(x()), left, top, static_cast<unsigned>(width),
                                        static_cast<unsigned>(height), 0, CopyFromParent, InputOutput, nullptr,
                                        CWOverrideRedirect | CWBackPixel, &attributes);
    XMapRaised(x(), window);
    XSync(x(), False);
    return window;
  }

  template <class ColourAt>
  void put(Drawable target, int width, int height, const ColourAt& colourAt) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) pixels.push_back(colourAt(x, y));
    }
    const std::unique_ptr<XImage, decltype(&XFree)> image(
        XCreateImage(x(), XDefaultVisual(x(), screen_), 24, ZPixmap, 0, reinterpret_cast<char*>(pixels.data()),
                     static_cast<unsigned>(width), static_cast<unsigned>(height), 32, 0),
        &XFree);
    XPutImage(x(), target, XDefaultGC(x(), screen_), image.get(), 0, 0, 0, 0, static_cast<unsigned>(width),
              static_cast<unsigned>(height));
    XSync(x(), False);
  }

  [[nodiscard]] Pixmap pixmap(const Image8& photo) {
    const Pixmap pixmap = XCreatePixmap(x(), XDefaultRootWindow(x()), static_cast<unsigned>(photo.width()),
                                        static_cast<unsigned>(photo.height()), 24);
    put(pixmap, photo.width(), photo.height(), [&photo](int column, int row) { return colour(photo, column, row); });
    return pixmap;
  }

  void tile(Window target, Pixmap photo, int shiftX, int shiftY) {
    XGCValues values{};
    values.fill_style = FillTiled;
    values.tile = photo;
    values.ts_x_origin = shiftX;
    values.ts_y_origin = shiftY;
    GC gc = XCreateGC(x(), target, GCFillStyle | GCTile | GCTileStipXOrigin | GCTileStipYOrigin, &values);
    XFillRectangle(x(), target, gc, 0, 0, static_cast<unsigned>(width_), static_cast<unsigned>(height_));
    XFreeGC(x(), gc);
  }

  void pause() const {
    XSync(x(), False);
    std::this_thread::sleep_for(kFrame);
  }

  std::unique_ptr<Display, CloseDisplay> connection_;
  int screen_ = 0, width_ = 0, height_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc == 3 ? argv[1] : "";
  try {
    if (scene == "photographs") Scene().slidePhotographs(argv[2]);
    if (scene == "video") Scene().playVideo(argv[2]);
    if (scene == "drag") Scene().dragWindow();
    std::fputs(kScenes, stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scene_client: %s\n", error.what());
    return 1;
  }
}
