#include "viewer/panel/panel_input.h"

#include <X11/keysym.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>

namespace pixelflex::viewer {
namespace {

struct Key {
  ImGuiKey key;
  std::uint32_t keysym;
};
constexpr std::array kKeys = {Key{ImGuiKey_Tab, XK_Tab},
                              Key{ImGuiKey_Tab, XK_ISO_Left_Tab},
                              Key{ImGuiKey_LeftArrow, XK_Left},
                              Key{ImGuiKey_RightArrow, XK_Right},
                              Key{ImGuiKey_UpArrow, XK_Up},
                              Key{ImGuiKey_DownArrow, XK_Down},
                              Key{ImGuiKey_PageUp, XK_Page_Up},
                              Key{ImGuiKey_PageDown, XK_Page_Down},
                              Key{ImGuiKey_Home, XK_Home},
                              Key{ImGuiKey_End, XK_End},
                              Key{ImGuiKey_Insert, XK_Insert},
                              Key{ImGuiKey_Delete, XK_Delete},
                              Key{ImGuiKey_Backspace, XK_BackSpace},
                              Key{ImGuiKey_Space, XK_space},
                              Key{ImGuiKey_Enter, XK_Return},
                              Key{ImGuiKey_KeyPadEnter, XK_KP_Enter},
                              Key{ImGuiKey_Escape, XK_Escape},
                              Key{ImGuiKey_A, XK_a},
                              Key{ImGuiKey_C, XK_c},
                              Key{ImGuiKey_V, XK_v},
                              Key{ImGuiKey_X, XK_x},
                              Key{ImGuiKey_Y, XK_y},
                              Key{ImGuiKey_Z, XK_z}};

bool isOneOf(std::uint32_t keysym, std::uint32_t left, std::uint32_t right) {
  return keysym == left || keysym == right;
}

void applyModifier(ImGuiIO& io, const devices::KeyStroke& stroke) {
  if (isOneOf(stroke.keysym, XK_Control_L, XK_Control_R)) io.KeyCtrl = stroke.pressed;
  if (isOneOf(stroke.keysym, XK_Shift_L, XK_Shift_R)) io.KeyShift = stroke.pressed;
  if (isOneOf(stroke.keysym, XK_Alt_L, XK_Alt_R)) io.KeyAlt = stroke.pressed;
}

/// The character that a keysym means; none for others.
std::optional<unsigned> characterOf(std::uint32_t keysym) {
  constexpr std::uint32_t kUnicode = 0x01000000;
  const bool latin = (keysym >= 0x20 && keysym <= 0x7E) || (keysym >= 0xA0 && keysym <= 0xFF);
  if (latin) return keysym;
  if (keysym >= XK_KP_0 && keysym <= XK_KP_9) return keysym - XK_KP_0 + '0';
  if (keysym == XK_KP_Decimal) return '.';
  if (keysym > kUnicode && keysym <= kUnicode + 0xFFFF) return keysym - kUnicode;
  return std::nullopt;
}

void applyKey(ImGuiIO& io, const devices::KeyStroke& stroke) {
  applyModifier(io, stroke);
  const std::uint32_t keysym = stroke.letter != 0 ? static_cast<std::uint32_t>(stroke.letter) : stroke.keysym;
  const auto found = std::ranges::find(kKeys, keysym, &Key::keysym);
  if (found != kKeys.end()) io.KeysDown[io.KeyMap[found->key]] = stroke.pressed;
  if (!stroke.pressed || io.KeyCtrl || io.KeyAlt) return;
  if (const auto character = characterOf(stroke.keysym)) io.AddInputCharacter(*character);
}

/// Its own place in ImGui's list; -1 for those that it has none for.
int buttonIndex(int button) {
  constexpr std::array kButtons = {-1, 0, 2, 1};
  return button >= 1 && button <= 3 ? kButtons.at(static_cast<std::size_t>(button)) : -1;
}

}  // namespace

void PanelInput::begin() {
  ImGuiIO& io = ImGui::GetIO();
  for (std::size_t i = 0; i < kKeys.size(); ++i) io.KeyMap[kKeys.at(i).key] = static_cast<int>(kKeys.at(i).key) + 1;
}

void PanelInput::apply() {
  ImGuiIO& io = ImGui::GetIO();
  bool pressed = false;  // a button or a key, which takes a frame to be seen
  bool moved = false;    // and where the pointer is must have been seen before a button goes down there
  while (!events_.empty()) {
    const Event& event = events_.front();
    if (const auto* position = std::get_if<glm::dvec2>(&event)) {
      // A button belongs to where the pointer was then.
      if (pressed) return;
      moved = true;
      io.MousePos = {static_cast<float>(position->x), static_cast<float>(position->y)};
    } else if (const auto* scroll = std::get_if<Scroll>(&event)) {
      io.MouseWheel += static_cast<float>(scroll->steps.y);
      io.MouseWheelH += static_cast<float>(scroll->steps.x);
    } else if (pressed) {
      return;
    } else if (const auto* button = std::get_if<Button>(&event)) {
      if (moved) return;
      const int index = buttonIndex(button->button);
      if (index >= 0) io.MouseDown[index] = button->pressed;
      pressed = true;
    } else {
      applyKey(io, std::get<devices::KeyStroke>(event));
      pressed = true;
    }
    events_.pop_front();
  }
}

}  // namespace pixelflex::viewer
