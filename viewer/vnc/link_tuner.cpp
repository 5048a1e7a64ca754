#include "viewer/vnc/link_tuner.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pixelflex::viewer {
namespace {

using namespace std::chrono_literals;

struct Step {
  LinkSettings settings;
  double leastRate;  // bits per second
};

constexpr std::array<Step, 5> kSteps = {{{{.quality = 9, .compression = 1}, 40e6},
                                         {{.quality = 8, .compression = 2}, 16e6},
                                         {{.quality = 6, .compression = 3}, 5e6},
                                         {{.quality = 5, .compression = 4}, 1.5e6},
                                         {{.quality = 3, .compression = 6}, 0}}};
constexpr std::size_t kWorstNearby = 1;
constexpr auto kNearby = 2ms;
constexpr std::size_t kFarStep = 2;
constexpr auto kFar = 20ms;

// A measurement takes so much, or so long.
constexpr std::uint64_t kEnoughBytes = 256 << 10;
constexpr auto kEnoughTime = 1s;
// What is less than a few packets says nothing of a rate.
constexpr std::uint64_t kFewBytes = 4096;
constexpr auto kLittleTime = 50ms;

constexpr int kSlowBeforeDown = 2;
constexpr int kFastBeforeUp = 3;
constexpr double kRoomToRise = 2;  // the rate that the better step needs, times this
constexpr auto kRestBeforeUp = 10s;

}  // namespace

LinkTuner::LinkTuner(std::chrono::nanoseconds firstRoundTrip) : step_(firstRoundTrip >= kFar ? kFarStep : 0) {}

LinkSettings LinkTuner::settings() const {
  return kSteps.at(step_).settings;
}

bool LinkTuner::received(std::uint64_t bytes, std::chrono::nanoseconds waiting, Time now) {
  if (bytes < kFewBytes && waiting < kLittleTime) return false;
  bytes_ += bytes;
  waiting_ += std::max(waiting, std::chrono::nanoseconds(0));
  if (bytes_ < kEnoughBytes && waiting_ < kEnoughTime) return false;
  rate_ = 8.0 * static_cast<double>(bytes_) / std::max(std::chrono::duration<double>(waiting_).count(), 1e-6);
  bytes_ = 0;
  waiting_ = 0ns;
  return judge(now);
}

std::size_t LinkTuner::stepFor(double rate) const {
  const auto fits = [rate](const Step& step) { return rate >= step.leastRate; };
  const auto step = static_cast<std::size_t>(std::ranges::find_if(kSteps, fits) - kSteps.begin());
  return roundTrip_ && *roundTrip_ < kNearby ? std::min(step, kWorstNearby) : step;
}

bool LinkTuner::judge(Time now) {
  const std::size_t wanted = stepFor(rate_);
  slow_ = wanted > step_ ? slow_ + 1 : 0;
  const bool first = !std::exchange(judged_, true);
  if (slow_ == 0 || (slow_ < kSlowBeforeDown && !first)) return rise(now);
  step_ = wanted;
  slow_ = fast_ = 0;
  changed_ = now;
  return true;
}

bool LinkTuner::rise(Time now) {
  const bool room = step_ > 0 && rate_ >= kRoomToRise * kSteps.at(step_ - 1).leastRate;
  fast_ = room ? fast_ + 1 : 0;
  if (fast_ < kFastBeforeUp || now - changed_ < kRestBeforeUp) return false;
  --step_;
  fast_ = 0;
  changed_ = now;
  return true;
}

}  // namespace pixelflex::viewer
