#include "viewer/vnc/held_input.h"

#include <utility>

namespace pixelflex::viewer {

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
  for (const std::uint32_t keysym : std::exchange(broken_, {})) releases.emplace_back(KeyInput{keysym, false});
  pointer_.buttons = 0;
  if (pointed_) releases.emplace_back(pointer_);
  return releases;
}

}  // namespace pixelflex::viewer
