#include "viewer/programs/model_navigation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/programs/modifier_keys.h"

namespace pixelflex::viewer {
namespace {

// X11 keysyms, as in X11/keysymdef.h; those of Latin letters are their codes.
constexpr std::uint32_t kEscape = 0xFF1B;
constexpr std::uint32_t kHome = 0xFF50;
constexpr std::uint32_t kLeft = 0xFF51;
constexpr std::uint32_t kUp = 0xFF52;
constexpr std::uint32_t kRight = 0xFF53;
constexpr std::uint32_t kDown = 0xFF54;
constexpr std::uint32_t kShiftLeft = 0xFFE1;
constexpr std::uint32_t kShiftRight = 0xFFE2;

constexpr double kTurn = 180;  // degrees for a drag across the shorter side
constexpr double kKeyTurn = 5;
constexpr double kFlight = 0.05;  // shorter sides
constexpr double kZoomStep = 1.1;

}  // namespace

ModelNavigation::ModelNavigation(const ModelPose& start, bool wireframe, bool axes, std::optional<glm::dvec4> cut,
                                 double span)
    : start_(start), pose_(start), wireframe_(wireframe), axes_(axes), cut_(cut), span_(span) {}

void ModelNavigation::button(int button, bool pressed) {
  held_ = pressed ? button : 0;
}

void ModelNavigation::pointer(glm::dvec2 pointInDesktop) {
  const auto before = std::exchange(last_, pointInDesktop);
  if (!before || held_ < 1 || held_ > 3) return;
  const glm::dvec2 by = (pointInDesktop - *before) / span_;
  if (by == glm::dvec2(0)) return;
  if (held_ == 1 && !shift_) {
    pose_.yaw += kTurn * by.x;
    pose_.pitch += kTurn * by.y;
  } else {
    pose_.shift += glm::dvec3(by.x, -by.y, 0);
  }
  changed_ = true;
}

void ModelNavigation::scroll(double steps) {
  pose_.zoom = std::clamp(pose_.zoom * std::pow(kZoomStep, steps), 1e-3, 1e3);
  changed_ = true;
}

void ModelNavigation::key(const devices::KeyStroke& stroke) {
  if (stroke.keysym == kShiftLeft || stroke.keysym == kShiftRight) shift_ = stroke.pressed;
  if (isControl(stroke.keysym)) control_ = stroke.pressed;
  if (isAlt(stroke.keysym)) alt_ = stroke.pressed;
  if (!stroke.pressed) return;
  quit_ = quit_ || stroke.keysym == kEscape || (control_ && alt_ && stroke.letter == 'q');
  if (!control_) press(stroke.keysym);
}

void ModelNavigation::press(std::uint32_t keysym) {
  changed_ = true;
  switch (keysym) {
    case kLeft:
    case kRight:
      pose_.yaw += keysym == kRight ? kKeyTurn : -kKeyTurn;
      break;
    case kUp:
    case kDown:
      pose_.pitch += keysym == kDown ? kKeyTurn : -kKeyTurn;
      break;
    case 'w':
    case 's':  // the viewer flies, so the model comes or goes
      pose_.shift.z += keysym == 'w' ? kFlight : -kFlight;
      break;
    case 'a':
    case 'd':
      pose_.shift.x += keysym == 'a' ? kFlight : -kFlight;
      break;
    case 'e':
    case 'q':
      pose_.shift.y += keysym == 'q' ? kFlight : -kFlight;
      break;
    case '+':
    case '-':
      scroll(keysym == '+' ? 1 : -1);
      break;
    case 'f':
      pose_.zoom = 1;
      pose_.shift = {0, 0, 0};
      break;
    case kHome:
      pose_ = start_;
      break;
    case 'l':
      wireframe_ = !wireframe_;
      break;
    case 'x':
      axes_ = !axes_;
      break;
    case 'c':
      toggleCut();
      break;
    case '[':
    case ']':
      if (ownCut_) *ownCut_ += keysym == ']' ? kFlight : -kFlight;
      break;
    default:
      changed_ = false;
  }
}

void ModelNavigation::toggleCut() {
  const bool cut = cut_ || ownCut_;
  cut_.reset();
  ownCut_ = cut ? std::nullopt : std::optional(0.0);
}

bool ModelNavigation::apply(ModelView& view) {
  view.pose = pose_;
  view.wireframe = wireframe_;
  view.axes = axes_;
  view.cut = cut_;
  // What is nearer to the viewer is cut away.
  if (ownCut_) view.cut = glm::dvec4(0, 0, -1, *ownCut_ * std::min(view.window.extent.x, view.window.extent.y));
  return std::exchange(changed_, false);
}

}  // namespace pixelflex::viewer
