// Where an update's time goes, told by a clock of the tests' own.
#include <gtest/gtest.h>

#include "viewer/tiles/stage_stats.h"

namespace pixelflex::viewer {
namespace {

using namespace std::chrono_literals;

const StageStats::Time kBegin{1h};

/// Received at `ms`, whole 8 ms later, 5 of them work.
Batch batchAt(std::uint64_t update, int ms, bool completes = true) {
  Batch batch;
  batch.update = update;
  batch.received = kBegin + ms * 1ms;
  batch.decoded = batch.received + 8ms;
  batch.decoding = 5ms;
  batch.completesUpdate = completes;
  return batch;
}

void expectAll(const StageFigures& figures, std::chrono::nanoseconds time) {
  EXPECT_EQ(figures.median, time);
  EXPECT_EQ(figures.p99, time);
  EXPECT_EQ(figures.max, time);
}

std::chrono::nanoseconds medianOf(const StageSummary& summary, Stage stage) {
  return summary.stages.at(static_cast<std::size_t>(stage)).median;
}

TEST(StageStats, AnUpdateInTwoBatchesIsOne) {
  StageStats stats;
  const Batch first = batchAt(1, 0, false);
  stats.uploaded(first, first.decoded + 2ms, first.decoded + 3ms);
  stats.uploaded(batchAt(1, 0), first.decoded + 7ms, first.decoded + 9ms);
  stats.drawn(first.decoded + 9ms, first.decoded + 20ms);
  stats.shown(first.decoded + 24ms);
  EXPECT_EQ(stats.count(), 1U);
  const StageSummary summary = stats.summaryOfLast(10);
  EXPECT_EQ(summary.updates, 1U);
  expectAll(summary.stages[0], 3ms);  // receive
  EXPECT_EQ(medianOf(summary, Stage::kDecode), 5ms);
  EXPECT_EQ(medianOf(summary, Stage::kQueue), 2ms);
  EXPECT_EQ(medianOf(summary, Stage::kUpload), 3ms);
  EXPECT_EQ(medianOf(summary, Stage::kDraw), 11ms);
  EXPECT_EQ(medianOf(summary, Stage::kSwap), 4ms);
  EXPECT_EQ(medianOf(summary, Stage::kTotal), 32ms);
}

TEST(StageStats, UpdatesDrawnTogetherEndTogether) {
  StageStats stats;
  for (const int ms : {0, 10})
    stats.uploaded(batchAt(static_cast<std::uint64_t>(ms), ms), kBegin + 20ms, kBegin + 21ms);
  stats.drawn(kBegin + 22ms, kBegin + 30ms);
  stats.shown(kBegin + 31ms);
  const StageSummary summary = stats.summaryOfLast(2);
  EXPECT_EQ(summary.updates, 2U);
  EXPECT_EQ(summary.stages.back().median, 21ms);
  EXPECT_EQ(summary.stages.back().max, 31ms);
}

TEST(StageStats, HalfAnUpdateIsNeitherDrawnNorKept) {
  StageStats stats;
  stats.uploaded(batchAt(1, 0, false), kBegin + 9ms, kBegin + 10ms);
  stats.drawn(kBegin + 10ms, kBegin + 11ms);
  stats.shown(kBegin + 12ms);
  EXPECT_EQ(stats.count(), 0U);
  // The connection broke: the next one begins anew.
  stats.uploaded(batchAt(2, 100), kBegin + 110ms, kBegin + 111ms);
  stats.drawn(kBegin + 111ms, kBegin + 112ms);
  stats.shown(kBegin + 112ms);
  EXPECT_EQ(medianOf(stats.summaryOfLast(1), Stage::kTotal), 12ms);
}

TEST(StageStats, KeepsTheLastAndTellsPercentilesOfThose) {
  StageStats stats;
  const auto show = [&](int total) {
    stats.uploaded(batchAt(static_cast<std::uint64_t>(total), 0), kBegin + 8ms, kBegin + 9ms);
    stats.drawn(kBegin + 9ms, kBegin + 10ms);
    stats.shown(kBegin + total * 1ms);
  };
  for (int i = 0; i < 3000; ++i) show(5000);
  for (int i = 1; i <= 101; ++i) show(100 + i);
  EXPECT_EQ(stats.count(), 3101U);
  EXPECT_EQ(stats.summaryOfLast(5000).updates, StageStats::kKept);
  const StageFigures total = stats.summaryOfLast(101).stages.back();
  EXPECT_EQ(total.median, 151ms);
  EXPECT_EQ(total.p99, 200ms);
  EXPECT_EQ(total.max, 201ms);
  EXPECT_EQ(stats.summaryOfLast(0).updates, 0U);
}

}  // namespace
}  // namespace pixelflex::viewer
