#include "viewer/x11/local_desktop.h"

#include <algorithm>
#include <utility>

namespace pixelflex::viewer {
namespace {

constexpr std::chrono::microseconds kPeriod{16'000};

}  // namespace

LocalDesktop::LocalDesktop(const XConnection& connection, bool takesInput)
    : connection_(connection), screen_(connection), cursor_(connection), xkb_(connection), told_(screen_.size()) {
  if (!takesInput) return;
  keyboard_.emplace(connection);
  pointer_.emplace(connection);
  clipboard_.emplace(connection);
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
    if (clipboard_) clipboard_->handle(*event);
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
  } else {
    clipboard_->offer(std::get<ClipboardInput>(input).text);
  }
}

std::vector<SessionEvent> LocalDesktop::takeEvents() {
  std::vector<SessionEvent> events;
  if (std::exchange(told_, size()) != size()) events.emplace_back(Resized{size()});
  std::ranges::move(cursor_.takeEvents(), std::back_inserter(events));
  if (xkb_.takeRung()) events.emplace_back(Bell{});
  if (clipboard_) {
    if (auto text = clipboard_->takeText()) events.emplace_back(Clipboard{std::move(*text)});
  }
  return events;
}

void LocalDesktop::publish(FrameBelt& belt, const std::stop_token& stop, std::uint64_t& serial) {
  due_ = std::chrono::steady_clock::now() + kPeriod;
  if (screen_.publish(serial + 1, belt, stop)) ++serial;
}

}  // namespace pixelflex::viewer
