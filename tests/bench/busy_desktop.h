#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "devices/image/image.h"
#include "viewer/tiles/box.h"

namespace pixelflex::testing {

/// A VNC server of libvncserver's in this process, at a port of 127.0.0.1, whose desktop changes as desktops do: text,
/// fills, gradients, noise, scrolling, single pixels, the pointer's shape, the clipboard, the bell. Always the same for
/// the same seed and sizes. One thread.
class BusyDesktop {
 public:
  explicit BusyDesktop(devices::Size size, unsigned seed = 1);
  ~BusyDesktop();
  BusyDesktop(const BusyDesktop&) = delete;
  BusyDesktop& operator=(const BusyDesktop&) = delete;

  /// As users write it.
  [[nodiscard]] std::string address() const;
  /// Listens to the clients and sends them what is due; returns after at most a few milliseconds.
  void serve();
  /// A client waits for a change and has got all earlier ones.
  [[nodiscard]] bool isAwaited() const;
  /// One change somewhere.
  void change();
  void resize(devices::Size size);
  /// As the clients must come to see it: red, green, blue.
  [[nodiscard]] devices::Image8 picture() const;

 private:
  struct Server;
  using Pixel = std::uint32_t;  // red in the lowest byte

  [[nodiscard]] int upTo(int largest) { return std::uniform_int_distribution<int>(0, largest)(random_); }
  [[nodiscard]] viewer::Box somewhere(int largest);
  Pixel& at(int x, int y) {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(x)];
  }
  template <class Colour>
  void paint(const viewer::Box& box, const Colour& colourAt);
  void scroll();
  void changePointer();

  std::mt19937 random_;
  devices::Size size_;
  std::vector<Pixel> pixels_;
  std::unique_ptr<Server> server_;
};

}  // namespace pixelflex::testing
