#include "viewer/vnc/jpeg_workers.h"

#include <algorithm>
#include <span>
#include <utility>

#include "viewer/vnc/jpeg_rect.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMostWaiting = 32;  // pictures; a server's are 64 kilopixels or so
constexpr unsigned kMostThreads = 3;      // besides the session's, which helps

bool touch(const Box& a, const Box& b) {
  return !intersect(a, b).empty();
}

bool decode(const JpegWorkers::Picture& picture) {
  return decodeJpegRect({picture.jpeg.get(), picture.bytes}, {picture.box.width(), picture.box.height()}, picture.out,
                        picture.rowBytes);
}

}  // namespace

JpegWorkers::~JpegWorkers() {
  const std::scoped_lock lock(mutex_);
  waiting_.clear();
  for (auto& thread : threads_) thread.request_stop();
}

void JpegWorkers::start() {
  if (!threads_.empty()) return;
  const unsigned count = std::clamp(std::thread::hardware_concurrency(), 2U, kMostThreads + 1) - 1;
  for (unsigned i = 0; i < count; ++i) threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
}

void JpegWorkers::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wanted_.wait(lock, stop, [this] { return !waiting_.empty(); })) decodeOne(lock);
}

void JpegWorkers::decodeOne(std::unique_lock<std::mutex>& lock) {
  const Picture picture = std::move(waiting_.front());
  waiting_.pop_front();
  beingDecoded_.push_back(picture.box);
  lock.unlock();
  const bool sound = decode(picture);
  lock.lock();
  beingDecoded_.erase(std::ranges::find(beingDecoded_, picture.box));
  damaged_ = damaged_ || !sound;
  decoded_.notify_all();
}

void JpegWorkers::add(Picture picture) {
  start();
  {
    std::unique_lock lock(mutex_);
    if (waiting_.size() >= kMostWaiting) decodeOne(lock);
    waiting_.push_back(std::move(picture));
  }
  wanted_.notify_one();
}

bool JpegWorkers::touches(const Box& box) const {
  return std::ranges::any_of(beingDecoded_, [&box](const Box& other) { return touch(other, box); }) ||
         std::ranges::any_of(waiting_, [&box](const Picture& picture) { return touch(picture.box, box); });
}

void JpegWorkers::waitFor(const Box& box) {
  if (threads_.empty()) return;
  std::unique_lock lock(mutex_);
  while (touches(box)) {
    if (waiting_.empty()) {
      decoded_.wait(lock);
    } else {
      decodeOne(lock);
    }
  }
}

bool JpegWorkers::finish() {
  if (threads_.empty()) return true;
  std::unique_lock lock(mutex_);
  while (!waiting_.empty()) decodeOne(lock);
  decoded_.wait(lock, [this] { return beingDecoded_.empty(); });
  return !std::exchange(damaged_, false);
}

}  // namespace pixelflex::viewer
