#include "viewer/x11/local_desktop.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace pixelflex::viewer {
namespace {

constexpr std::chrono::microseconds kPeriod{16'000};

}  // namespace

LocalDesktop::LocalDesktop(const XConnection& connection, const LocalInput& input)
    : connection_(connection),
      screen_(connection),
      cursor_(connection),
      xkb_(connection),
      clipboardLimit_(input.clipboardLimit),
      told_(screen_.size()) {
  if (!input.pointerAndKeys) return;
  keyboard_.emplace(connection);
  pointer_.emplace(connection);
  if (clipboardLimit_ == 0) return;
  addClipboard(Selection::kClipboard);
  if (input.primary) addClipboard(Selection::kPrimary);
}

void LocalDesktop::addClipboard(Selection selection) {
  clipboards_.emplace(std::piecewise_construct, std::forward_as_tuple(selection),
                      std::forward_as_tuple(connection_, selection, clipboardLimit_));
}

LocalDesktop::~LocalDesktop() {
  if (!keyboard_) return;
  keyboard_.reset();
  pointer_.reset();
  connection_.settle();
}

bool LocalDesktop::listen() {
  bool any = false;
  while (const auto event = connection_.nextEvent()) {
    any = true;
    screen_.handle(*event);
    cursor_.handle(*event);
    xkb_.handle(*event);
    if (keyboard_) keyboard_->handle(*event);
    if (keyboard_ && xkb_.takeLayoutChange()) keyboard_->forgetLayout();
    for (auto& [selection, clipboard] : clipboards_) clipboard.handle(*event);
  }
  return any;
}

void LocalDesktop::take(const Input& input) {
  if (const auto* pointer = std::get_if<PointerInput>(&input)) {
    const PointerInput inside{std::clamp(pointer->x, 0, std::max(size().width - 1, 0)),
                              std::clamp(pointer->y, 0, std::max(size().height - 1, 0)), pointer->buttons};
    pointer_->set(inside);
    cursor_.expectAt(inside.x, inside.y);
  } else if (const auto* key = std::get_if<KeyInput>(&input)) {
    if (key->down) {
      keyboard_->press(key->keysym);
    } else {
      keyboard_->release(key->keysym);
    }
  } else if (const auto* copied = std::get_if<ClipboardInput>(&input)) {
    offer(*copied);
  }
}

void LocalDesktop::offer(const ClipboardInput& copied) {
  const auto clipboard = clipboards_.find(copied.selection);
  if (clipboard != clipboards_.end() && copied.text.size() <= clipboardLimit_) clipboard->second.offer(copied.text);
}

std::vector<SessionEvent> LocalDesktop::takeEvents() {
  std::vector<SessionEvent> events;
  if (std::exchange(told_, size()) != size()) events.emplace_back(Resized{size()});
  std::ranges::move(cursor_.takeEvents(), std::back_inserter(events));
  if (xkb_.takeRung()) events.emplace_back(Bell{});
  for (auto& [selection, clipboard] : clipboards_) {
    if (auto text = clipboard.takeText()) events.emplace_back(Clipboard{std::move(*text), selection});
    if (clipboard.takeTooLong()) events.emplace_back(ClipboardRefused{true, clipboardLimit_});
  }
  return events;
}

void LocalDesktop::publish(FrameBelt& belt, const std::stop_token& stop, std::uint64_t& serial) {
  due_ = std::chrono::steady_clock::now() + kPeriod;
  if (screen_.publish(serial + 1, belt, stop)) ++serial;
}

}  // namespace pixelflex::viewer
