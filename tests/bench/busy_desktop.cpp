#include "tests/bench/busy_desktop.h"

#include <arpa/inet.h>
#include <rfb/rfb.h>
extern "C" {
#include <rfb/rfbregion.h>  // which does not say itself that it is C
}

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace pixelflex::testing {

using viewer::Box;

struct BusyDesktop::Server {
  struct Free {
    void operator()(rfbScreenInfo* screen) const {
      rfbShutdownServer(screen, TRUE);
      rfbScreenCleanup(screen);
    }
  };
  std::unique_ptr<rfbScreenInfo, Free> screen;
};

BusyDesktop::BusyDesktop(devices::Size size, unsigned seed)
    : random_(seed), size_(size), pixels_(static_cast<std::size_t>(size.area())), server_(std::make_unique<Server>()) {
  rfbLogEnable(0);
  rfbScreenInfo* screen = rfbGetScreen(nullptr, nullptr, size.width, size.height, 8, 3, 4);
  if (screen == nullptr) throw std::runtime_error("libvncserver makes no screen");
  server_->screen.reset(screen);
  screen->frameBuffer = reinterpret_cast<char*>(pixels_.data());
  screen->listenInterface = htonl(INADDR_LOOPBACK);
  screen->ipv6port = -1;
  screen->autoPort = TRUE;
  screen->alwaysShared = TRUE;
  screen->deferUpdateTime = 0;
  rfbInitServer(screen);
  if (screen->listenSock < 0) throw std::runtime_error("libvncserver does not listen");
}

BusyDesktop::~BusyDesktop() = default;

std::string BusyDesktop::address() const {
  return "127.0.0.1::" + std::to_string(server_->screen->port);
}

void BusyDesktop::serve() {
  rfbProcessEvents(server_->screen.get(), 2000);
}

bool BusyDesktop::isAwaited() const {
  const rfbClientRec* client = server_->screen->clientHead;
  return client != nullptr && client->state == rfbClientRec::RFB_NORMAL && !client->newFBSizePending &&
         sraRgnEmpty(client->requestedRegion) == FALSE && sraRgnEmpty(client->modifiedRegion) != FALSE &&
         sraRgnEmpty(client->copyRegion) != FALSE;
}

Box BusyDesktop::somewhere(int largest) {
  const int width = std::min(1 + upTo(largest), size_.width);
  const int height = std::min(1 + upTo(largest / 2), size_.height);
  const int left = upTo(size_.width - width);
  const int top = upTo(size_.height - height);
  return {left, top, left + width, top + height};
}

template <class Colour>
void BusyDesktop::paint(const Box& box, const Colour& colourAt) {
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) at(x, y) = colourAt(x, y) & 0xffffffU;
  }
  rfbMarkRectAsModified(server_->screen.get(), box.left, box.top, box.right, box.bottom);
}

void BusyDesktop::change() {
  const auto colour = static_cast<Pixel>(random_());
  const auto other = static_cast<Pixel>(random_());
  switch (upTo(19)) {
    case 0:
      return paint({0, 0, size_.width, size_.height}, [&](int, int) { return colour; });
    case 1:
    case 2:
      return paint(somewhere(80), [&](int, int) { return static_cast<Pixel>(random_()); });
    case 3:
    case 4:
      return paint(somewhere(200), [&](int x, int y) { return colour + static_cast<Pixel>(x * 0x10000 + y * 0x100); });
    case 5:
    case 6:
      return paint(somewhere(300), [&](int, int) { return colour; });
    case 7:
      return paint(somewhere(0), [&](int, int) { return colour; });
    case 8:
    case 9:
    case 10:
    case 11:
      return scroll();
    case 12:
      return changePointer();
    default:  // text
      return paint(somewhere(120), [&](int x, int y) { return (x * 7 + y * 3) % 5 < 2 ? colour : other; });
  }
}

// libvncserver moves the pixels itself.
void BusyDesktop::scroll() {
  const Box to = somewhere(400);
  const int dx = upTo(to.left + size_.width - to.right) - (size_.width - to.right);
  const int dy = upTo(to.top + size_.height - to.bottom) - (size_.height - to.bottom);
  rfbDoCopyRect(server_->screen.get(), to.left, to.top, to.right, to.bottom, dx, dy);
}

// Comes with a change of the desktop, because a pointer alone is no update of pixels.
void BusyDesktop::changePointer() {
  rfbScreenInfo* screen = server_->screen.get();
  const auto side = static_cast<std::size_t>(2 + upTo(14));
  const std::string shape(side * side, upTo(1) == 0 ? 'x' : ' ');
  std::string mask(side * side, 'x');
  rfbCursorPtr cursor =
      rfbMakeXCursor(static_cast<int>(side), static_cast<int>(side), const_cast<char*>(shape.data()), mask.data());
  cursor->cleanup = TRUE;
  rfbSetCursor(screen, cursor);
  rfbSendBell(screen);
  std::string text(static_cast<std::size_t>(1 + upTo(2000)), 'c');
  rfbSendServerCutText(screen, text.data(), static_cast<int>(text.size()));
  paint(somewhere(20), [](int x, int y) { return static_cast<Pixel>(x ^ y); });
}

void BusyDesktop::resize(devices::Size size) {
  std::vector<Pixel> fresh(static_cast<std::size_t>(size.area()));
  rfbNewFramebuffer(server_->screen.get(), reinterpret_cast<char*>(fresh.data()), size.width, size.height, 8, 3, 4);
  pixels_ = std::move(fresh);
  size_ = size;
  paint({0, 0, size.width, size.height}, [](int x, int y) { return static_cast<Pixel>(x / 8 * 0x30507 + y / 8); });
}

devices::Image8 BusyDesktop::picture() const {
  devices::Image8 image(size_, 3);
  auto sample = image.samples().begin();
  for (const Pixel pixel : pixels_) {
    for (int shift = 0; shift < 24; shift += 8) *sample++ = static_cast<std::uint8_t>(pixel >> shift);
  }
  return image;
}

}  // namespace pixelflex::testing
