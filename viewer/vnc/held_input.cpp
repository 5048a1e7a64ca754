#include "viewer/vnc/held_input.h"

#include <utility>

namespace pixelflex::viewer {
namespace {

/// Of X11/keysymdef.h: keys that mean nothing by themselves, without those that lock.
bool isModifier(std::uint32_t keysym) {
  constexpr std::uint32_t kShiftLeft = 0xffe1, kHyperRight = 0xffee, kCapsLock = 0xffe5, kShiftLock = 0xffe6;
  constexpr std::uint32_t kLevel3Shift = 0xfe03, kLevel5Shift = 0xfe11, kModeSwitch = 0xff7e;
  if (keysym == kCapsLock || keysym == kShiftLock) return false;
  const bool usual = keysym >= kShiftLeft && keysym <= kHyperRight;
  return usual || keysym == kLevel3Shift || keysym == kLevel5Shift || keysym == kModeSwitch;
}

}  // namespace

bool HeldInput::admit(Input& input) {
  if (auto* pointer = std::get_if<PointerInput>(&input)) {
    staleButtons_ &= pointer->buttons;
    pointer->buttons = static_cast<std::uint16_t>(pointer->buttons & ~staleButtons_);
    pointer_ = *pointer;
    pointed_ = true;
  } else if (const auto* key = std::get_if<KeyInput>(&input)) {
    if (key->down && stale_.contains(key->keysym)) return false;
    if (key->down) {
      down_.insert(key->keysym);
    } else {
      down_.erase(key->keysym);
      stale_.erase(key->keysym);
    }
  }
  return true;
}

void HeldInput::ignore(const Input& input) {
  if (const auto* pointer = std::get_if<PointerInput>(&input)) {
    staleButtons_ = pointer->buttons;
  } else if (const auto* key = std::get_if<KeyInput>(&input)) {
    if (key->down) {
      stale_.insert(key->keysym);
    } else {
      stale_.erase(key->keysym);
    }
  }
}

void HeldInput::lose() {
  stale_.insert(down_.begin(), down_.end());
  broken_.merge(std::exchange(down_, {}));
  staleButtons_ |= pointer_.buttons;
}

std::vector<Input> HeldInput::takeReleases() {
  std::vector<Input> releases;
  for (const std::uint32_t keysym : std::exchange(broken_, {})) {
    // TigerVNC's server lets nobody release what another connection has pressed, and one that it has not seen break
    // may hold keys for hours. A modifier can be pressed once more and nobody notices.
    if (isModifier(keysym)) releases.emplace_back(KeyInput{keysym, true});
    releases.emplace_back(KeyInput{keysym, false});
  }
  pointer_.buttons = 0;
  if (pointed_) releases.emplace_back(pointer_);
  return releases;
}

}  // namespace pixelflex::viewer
