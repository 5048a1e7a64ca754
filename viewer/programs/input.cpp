#include "viewer/programs/input.h"

#include <utility>

namespace pixelflex::viewer {
namespace {

// X11 keysyms, as in X11/keysymdef.h.
constexpr std::uint32_t kControlLeft = 0xFFE3;
constexpr std::uint32_t kControlRight = 0xFFE4;
constexpr std::uint32_t kAltLeft = 0xFFE9;
constexpr std::uint32_t kAltRight = 0xFFEA;

/// RFB button masks have one bit per X button, 1 to 8.
std::uint8_t bitOf(int button) {
  return button >= 1 && button <= 8 ? static_cast<std::uint8_t>(1 << (button - 1)) : 0;
}

}  // namespace

devices::WindowHandlers Input::handlers(Map desktopFromWindow, std::function<void()> redraw) {
  return {.pointer = [this, map = std::move(desktopFromWindow)](glm::dvec2 p) { move(map(p)); },
          .button = [this](int number, bool pressed) { button(number, pressed); },
          .scroll = [this](glm::dvec2 steps) { scroll(steps); },
          .key = [this](std::uint32_t keysym, bool pressed) { key(keysym, pressed); },
          .close = onQuit_,
          .redraw = std::move(redraw)};
}

void Input::move(std::optional<glm::ivec2> pointInDesktop) {
  if (!pointInDesktop) return;
  position_ = *pointInDesktop;
  view_.point(position_, buttons_);
}

void Input::button(int number, bool pressed) {
  const std::uint8_t bit = bitOf(number);
  buttons_ = static_cast<std::uint8_t>(pressed ? buttons_ | bit : buttons_ & ~bit);
  view_.point(position_, buttons_);
}

/// Wheels are buttons 4 to 7 in X; smooth wheels send fractions of a notch.
void Input::scroll(glm::dvec2 steps) {
  unscrolled_ += steps;
  const auto click = [this](int number) {
    button(number, true);
    button(number, false);
  };
  for (; unscrolled_.y >= 1; unscrolled_.y -= 1) click(4);
  for (; unscrolled_.y <= -1; unscrolled_.y += 1) click(5);
  for (; unscrolled_.x >= 1; unscrolled_.x -= 1) click(6);
  for (; unscrolled_.x <= -1; unscrolled_.x += 1) click(7);
}

void Input::key(std::uint32_t keysym, bool pressed) {
  if (keysym == kControlLeft || keysym == kControlRight) control_ = pressed;
  if (keysym == kAltLeft || keysym == kAltRight) alt_ = pressed;
  if (pressed && control_ && alt_ && (keysym == 'q' || keysym == 'Q')) {
    // What is held down must not stay so on the desktop.
    for (const std::uint32_t modifier : {kControlLeft, kControlRight, kAltLeft, kAltRight}) view_.key(modifier, false);
    onQuit_();
    return;
  }
  view_.key(keysym, pressed);
}

}  // namespace pixelflex::viewer
