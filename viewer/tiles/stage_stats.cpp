#include "viewer/tiles/stage_stats.h"

#include <algorithm>
#include <cassert>

namespace pixelflex::viewer {
namespace {

constexpr std::array<std::string_view, kStages> kNames = {"receive", "decode", "queue", "upload",
                                                          "draw",    "swap",   "total"};
// More than one step of the render thread takes off the belt, unless the server is very fast.
constexpr std::size_t kUsuallyOpen = 64;

std::size_t indexOf(Stage stage) {
  return static_cast<std::size_t>(stage);
}

// Sorted values.
StageFigures figuresOf(const std::vector<std::chrono::nanoseconds>& times) {
  const std::size_t last = times.size() - 1;
  return {times[last / 2], times[(last * 99 + 99) / 100], times[last]};
}

}  // namespace

std::string_view nameOf(Stage stage) {
  return kNames.at(indexOf(stage));
}

StageStats::StageStats() {
  open_.reserve(kUsuallyOpen);
  samples_.reserve(kKept);
}

void StageStats::uploaded(const Batch& batch, Time begin, Time end) {
  // One that broke off goes when the next one comes.
  if (!open_.empty() && !open_.back().complete && open_.back().update != batch.update) open_.pop_back();
  if (open_.empty() || open_.back().complete) {
    Open& fresh = open_.emplace_back();
    fresh.update = batch.update;
    fresh.received = batch.received;
    fresh.sample[indexOf(Stage::kReceive)] =
        std::max(batch.decoded - batch.received - batch.decoding, std::chrono::nanoseconds(0));
    fresh.sample[indexOf(Stage::kDecode)] = batch.decoding;
    fresh.sample[indexOf(Stage::kQueue)] = begin - batch.decoded;
  }
  open_.back().sample[indexOf(Stage::kUpload)] += end - begin;
  open_.back().complete = batch.completesUpdate;
}

void StageStats::drawn(Time begin, Time end) {
  for (Open& update : open_) {
    if (!update.complete || update.isDrawn) continue;
    update.isDrawn = true;
    update.drawn = end;
    update.sample[indexOf(Stage::kDraw)] = end - begin;
  }
}

void StageStats::shown(Time end) {
  for (Open& update : open_) {
    if (!update.isDrawn) continue;
    update.sample[indexOf(Stage::kSwap)] = end - update.drawn;
    update.sample[indexOf(Stage::kTotal)] = end - update.received;
    if (samples_.size() < kKept) samples_.emplace_back();
    samples_[count_++ % kKept] = update.sample;
  }
  std::erase_if(open_, [](const Open& update) { return update.isDrawn; });
}

StageSummary StageStats::summaryOfLast(std::uint64_t updates) const {
  StageSummary summary;
  summary.updates = static_cast<std::size_t>(std::min<std::uint64_t>(updates, samples_.size()));
  if (summary.updates == 0) return summary;
  std::vector<std::chrono::nanoseconds> times(summary.updates);
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = samples_[(count_ - 1 - i) % kKept][stage];
    std::ranges::sort(times);
    summary.stages[stage] = figuresOf(times);
  }
  return summary;
}

}  // namespace pixelflex::viewer
