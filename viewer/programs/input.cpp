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
                      .key = [this](const devices::KeyStroke& stroke) { key(stroke); },
                      .focus = [this, pane](bool focused) { focus(pane, focused); },
                      .close = commands_.quit,
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

void Input::grabKeyboard() {
  setGrab(true);
}

void Input::setGrab(bool grabs) {
  grabs_ = grabs;
  followFocus();
}

void Input::focus(std::size_t pane, bool focused) {
  if (focused) {
    focused_ = pane;
  } else if (focused_ == pane) {
    focused_.reset();
  }
  followFocus();
}

/// Where another program has the keyboard for a moment, as window managers have during their own shortcuts, the next
/// key or button is another attempt.
void Input::followFocus() {
  const auto wanted = grabs_ ? focused_ : std::nullopt;
  if (grabbed_ == wanted) return;
  if (const auto old = std::exchange(grabbed_, std::nullopt)) panes_[*old].window->releaseKeyboard();
  if (wanted && panes_[*wanted].window->grabKeyboard()) grabbed_ = wanted;
}

void Input::move(std::optional<glm::ivec2> pointInDesktop) {
  if (!pointInDesktop) return;
  if (buttons_ == 0 && shake_.move(glm::dvec2(*pointInDesktop), PointerShake::Clock::now())) view_.findPointer();
  view_.point(*pointInDesktop, buttons_);
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
  if (view_.pointerMap() == nullptr) return;
  unmoved_ += pixels;
  const glm::dvec2 whole{std::trunc(unmoved_.x), std::trunc(unmoved_.y)};
  unmoved_ -= whole;
  move(view_.pointerMap()->hold(glm::dvec2(view_.pointer()) + whole));
}

void Input::button(int number, bool pressed) {
  followFocus();
  taps_.forget();
  shake_.forget();
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

void Input::key(const devices::KeyStroke& stroke) {
  const auto [keysym, pressed, letter] = stroke;
  if (pressed) followFocus();
  if (taps_.key(keysym, pressed, ControlTaps::Clock::now())) view_.findPointer();
  if (command_ == keysym) {
    if (!pressed) command_.reset();
    return;
  }
  if (isControl(keysym) || isAlt(keysym)) {
    pressed ? (void)modifiers_.insert(keysym) : (void)modifiers_.erase(keysym);
  } else if (pressed && takenAsCommand(stroke)) {
    return;
  }
  view_.key(keysym, pressed);
}

/// With Ctrl and Alt: Q leaves, G lets pointer and keyboard go, S shows the statistics.
bool Input::takenAsCommand(const devices::KeyStroke& stroke) {
  if (!std::ranges::any_of(modifiers_, isControl) || !std::ranges::any_of(modifiers_, isAlt)) return false;
  if (stroke.letter != 'q' && stroke.letter != 'g' && stroke.letter != 's') return false;
  command_ = stroke.keysym;
  // What is held down must not stay so on the desktop.
  for (const std::uint32_t modifier : modifiers_) view_.key(modifier, false);
  if (stroke.letter == 'q') {
    commands_.quit();
  } else if (stroke.letter == 's') {
    commands_.stats();
  } else {
    const bool take = !locked_ && !grabs_;
    setGrab(take);
    if (lockable_) setLock(take);
  }
  return true;
}

}  // namespace pixelflex::viewer
