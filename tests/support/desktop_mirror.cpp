#include "tests/support/desktop_mirror.h"

#include <algorithm>
#include <iterator>

#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

viewer::SessionOptions optionsFor(const std::string& address) {
  viewer::SessionOptions options;
  options.server = viewer::parseServerAddress(address);
  return options;
}

}  // namespace

DesktopMirror::DesktopMirror(const Make& make) : belt_([this] { wake(); }), session_(make(belt_, [this] { wake(); })) {}

DesktopMirror::DesktopMirror(viewer::SessionOptions options)
    : DesktopMirror([&options](viewer::FrameBelt& belt, std::function<void()> wake) {
        return std::make_unique<viewer::Session>(std::move(options), belt, std::move(wake));
      }) {}

DesktopMirror::DesktopMirror(const std::string& address) : DesktopMirror(optionsFor(address)) {}

void DesktopMirror::wake() {
  {
    const std::lock_guard lock(mutex_);
    pending_ = true;
  }
  arrived_.notify_one();
}

bool DesktopMirror::pumpUntil(const std::function<bool()>& done, std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (true) {
    takeAll();
    if (done()) return true;
    const auto now = std::chrono::steady_clock::now();
    if (now >= deadline) return false;
    std::unique_lock lock(mutex_);
    arrived_.wait_until(lock, std::min(deadline, now + std::chrono::milliseconds(50)), [this] { return pending_; });
    pending_ = false;
  }
}

void DesktopMirror::pumpFor(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  pumpUntil([end] { return std::chrono::steady_clock::now() >= end; }, time + std::chrono::seconds(1));
}

bool DesktopMirror::pumpUntilStill(std::chrono::milliseconds quiet, std::chrono::milliseconds timeout) {
  auto since = std::chrono::steady_clock::now();
  std::uint64_t seen = updates_;
  return pumpUntil(
      [&] {
        const auto now = std::chrono::steady_clock::now();
        if (updates_ != seen) since = now;
        seen = updates_;
        return now - since >= quiet;
      },
      timeout);
}

bool DesktopMirror::pumpUntilEqual(const std::string& display, std::chrono::milliseconds timeout) {
  return pumpUntil([&] { return !desktop_.empty() && desktop_ == grabRoot(display); }, timeout);
}

std::string DesktopMirror::summary() const {
  std::string text = std::to_string(updates_) + " updates, " + std::to_string(events_.size()) + " events, desktop " +
                     std::to_string(desktop_.width()) + "x" + std::to_string(desktop_.height());
  if (const auto closed = last<viewer::Closed>()) text += ", closed: " + closed->message;
  return text;
}

void DesktopMirror::takeAll() {
  while (viewer::Batch* batch = belt_.take()) {
    apply(*batch);
    belt_.release(batch);
  }
  std::ranges::move(session_->takeEvents(), std::back_inserter(events_));
}

void DesktopMirror::apply(const viewer::Batch& batch) {
  if (desktop_.size() != batch.desktop) desktop_ = devices::Image8(batch.desktop, 3);
  const std::byte* pixel = batch.pixels.data();
  for (const viewer::Box& box : batch.boxes) {
    for (int y = box.top; y < box.bottom; ++y) {
      std::uint8_t* out = &desktop_.at(box.left, y);
      for (int x = box.left; x < box.right; ++x, pixel += 4, out += 3) {
        for (int channel = 0; channel < 3; ++channel) out[channel] = std::to_integer<std::uint8_t>(pixel[channel]);
      }
    }
  }
  batches_ += 1;
  bytes_ += batch.pixels.size();
  updates_ += batch.completesUpdate ? 1 : 0;
}

}  // namespace pixelflex::testing
