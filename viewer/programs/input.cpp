#include "viewer/programs/input.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/programs/modifier_keys.h"

namespace pixelflex::viewer {
namespace {

bool inside(glm::dvec2 p, devices::Size size) {
  return p.x >= 0 && p.y >= 0 && p.x < size.width && p.y < size.height;
}

/// One bit for each X button.
std::uint16_t bitOf(int button) {
  return button >= 1 && button <= 15 ? static_cast<std::uint16_t>(1U << (button - 1)) : std::uint16_t{0};
}

}  // namespace

void Input::take(devices::Window& window, Map desktopFromWindow, std::function<void()> redraw, bool joins) {
  const std::size_t pane = panes_.size();
  panes_.push_back({&window, std::move(desktopFromWindow), joins});
  window.setHandlers({.pointer = [this, pane](glm::dvec2 p) { moveIn(pane, p); },
                      .motion = [this](glm::dvec2 by) { moveBy(by); },
                      .button = [this](int number, bool pressed) { button(number, pressed); },
                      .scroll = [this](glm::dvec2 steps) { scroll(steps); },
                      .key = [this](std::uint32_t keysym, bool pressed) { key(keysym, pressed); },
                      .close = onQuit_,
                      .redraw = std::move(redraw)});
}

void Input::lockPointer() {
  lockable_ = true;
  setLock(true);
}

void Input::setLock(bool locked) {
  locked_ = locked;
  for (const Pane& pane : panes_) {
    if (pane.joins) pane.window->lockPointer(locked);
  }
}

void Input::move(std::optional<glm::ivec2> pointInDesktop) {
  if (pointInDesktop) view_.point(*pointInDesktop, buttons_);
}

void Input::moveIn(std::size_t pane, glm::dvec2 pointInWindow) {
  const Pane& here = panes_[pane];
  const bool left = here.joins && !inside(pointInWindow, here.window->size());
  const auto next = left ? besides(here, pointInWindow) : std::nullopt;
  move(next ? next : here.map(pointInWindow));
}

/// While a button is held the window where it was pressed is told where the pointer is, also when it is over another.
std::optional<glm::ivec2> Input::besides(const Pane& pane, glm::dvec2 pointInWindow) const {
  const glm::dvec2 pointOnScreen = pointInWindow + glm::dvec2(pane.window->position());
  for (const Pane& other : panes_) {
    if (!other.joins || other.window == pane.window) continue;
    const glm::dvec2 there = pointOnScreen - glm::dvec2(other.window->position());
    if (inside(there, other.window->size())) return other.map(there);
  }
  return std::nullopt;
}

void Input::moveBy(glm::dvec2 pixels) {
  const auto [width, height] = view_.desktop();
  if (width == 0 || height == 0) return;
  unmoved_ += pixels;
  const glm::dvec2 whole{std::trunc(unmoved_.x), std::trunc(unmoved_.y)};
  unmoved_ -= whole;
  const glm::ivec2 to = view_.pointer() + glm::ivec2(whole);
  move(glm::ivec2(std::clamp(to.x, 0, width - 1), std::clamp(to.y, 0, height - 1)));
}

void Input::button(int number, bool pressed) {
  taps_.forget();
  const std::uint16_t bit = bitOf(number);
  buttons_ = static_cast<std::uint16_t>(pressed ? buttons_ | bit : buttons_ & ~bit);
  view_.point(view_.pointer(), buttons_);
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
  if (taps_.key(keysym, pressed, ControlTaps::Clock::now())) view_.findPointer();
  if (isControl(keysym) || isAlt(keysym)) {
    pressed ? (void)modifiers_.insert(keysym) : (void)modifiers_.erase(keysym);
  } else if (pressed && takenAsCommand(keysym)) {
    return;
  }
  view_.key(keysym, pressed);
}

/// With Ctrl and Alt: Q leaves, G lets the pointer go.
bool Input::takenAsCommand(std::uint32_t keysym) {
  if (!std::ranges::any_of(modifiers_, isControl) || !std::ranges::any_of(modifiers_, isAlt)) return false;
  const bool quits = keysym == 'q' || keysym == 'Q';
  const bool unlocks = lockable_ && (keysym == 'g' || keysym == 'G');
  if (!quits && !unlocks) return false;
  // What is held down must not stay so on the desktop.
  for (const std::uint32_t modifier : std::exchange(modifiers_, {})) view_.key(modifier, false);
  if (quits) onQuit_();
  if (unlocks) setLock(!locked_);
  return true;
}

}  // namespace pixelflex::viewer
