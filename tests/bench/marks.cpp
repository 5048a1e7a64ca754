#include "tests/bench/marks.h"

#include <X11/Xlib.h>

#include <stdexcept>
#include <utility>

namespace pixelflex::testing {
namespace {

constexpr int kExtent = 64;
constexpr int kColumns = 4;
constexpr int kPlaces = 12;

}  // namespace

struct Marks::X {
  Display* display = nullptr;
  Window root = 0;
  GC pen = nullptr;
};

Marks::Marks(const std::string& display, devices::Size desktop) : x_(std::make_unique<X>()), desktop_(desktop) {
  x_->display = XOpenDisplay(display.c_str());
  if (x_->display == nullptr) throw std::runtime_error("cannot open the display " + display);
  x_->root = XDefaultRootWindow(x_->display);
  x_->pen = XCreateGC(x_->display, x_->root, 0, nullptr);
}

Marks::~Marks() {
  XCloseDisplay(x_->display);
}

glm::ivec2 Marks::placeOf(std::uint64_t number) const {
  const int place = static_cast<int>(number * 5 % kPlaces);
  return {(2 * (place % kColumns) + 1) * desktop_.width / (2 * kColumns) - kExtent / 2,
          (2 * (place / kColumns) + 1) * desktop_.height * kColumns / (2 * kPlaces) - kExtent / 2};
}

std::uint32_t Marks::colourOf(std::uint64_t number) {
  return static_cast<std::uint32_t>((number + 1) * 0x9e3779U) & 0xffffffU;
}

void Marks::draw() {
  const glm::ivec2 at = placeOf(drawn_);
  XSetForeground(x_->display, x_->pen, colourOf(drawn_));
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({drawn_, Clock::now()});
  }
  XFillRectangle(x_->display, x_->root, x_->pen, at.x, at.y, kExtent, kExtent);
  XFlush(x_->display);
  ++drawn_;
}

void Marks::look(const Look& look) {
  const std::lock_guard lock(mutex_);
  while (!waiting_.empty()) {
    const Mark& mark = waiting_.front();
    if (look(placeOf(mark.number)) != colourOf(mark.number)) return;
    milliseconds_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - mark.drawn).count());
    waiting_.pop_front();
  }
}

bool Marks::allSeen() const {
  const std::lock_guard lock(mutex_);
  return waiting_.empty();
}

std::vector<double> Marks::take() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
  return std::exchange(milliseconds_, {});
}

}  // namespace pixelflex::testing
