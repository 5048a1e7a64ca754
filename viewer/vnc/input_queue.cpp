#include "viewer/vnc/input_queue.h"

#include <algorithm>

namespace pixelflex::viewer {

void InputQueue::add(Input input) {
  if (const auto* pointer = std::get_if<PointerInput>(&input)) {
    addPointer(*pointer);
    return;
  }
  if (const auto* clipboard = std::get_if<ClipboardInput>(&input)) {
    std::erase_if(waiting_, [&](const Input& old) {
      const auto* other = std::get_if<ClipboardInput>(&old);
      return other != nullptr && other->selection == clipboard->selection;
    });
  }
  waiting_.push_back(std::move(input));
  lastIsMotion_ = false;
}

void InputQueue::addPointer(const PointerInput& pointer) {
  const bool motion = pointer.buttons == buttons_;
  buttons_ = pointer.buttons;
  if (motion && lastIsMotion_ && !waiting_.empty()) {
    waiting_.back() = pointer;
  } else {
    waiting_.emplace_back(pointer);
  }
  lastIsMotion_ = motion;
}

}  // namespace pixelflex::viewer
