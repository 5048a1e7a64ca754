#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

#include "viewer/tiles/frame_belt.h"

namespace pixelflex::viewer {
namespace {

std::byte patternOf(std::uint64_t update, std::size_t i) {
  return static_cast<std::byte>(update * 31 + i);
}

void fill(Batch& batch, std::uint64_t update) {
  batch.update = update;
  batch.completesUpdate = true;
  batch.boxes.push_back({0, 0, 16, 16});
  for (std::size_t i = 0; i < 1024; ++i) batch.pixels.push_back(patternOf(update, i));
}

void expectIntact(const Batch& batch, std::uint64_t update) {
  ASSERT_EQ(batch.update, update);
  ASSERT_TRUE(batch.completesUpdate);
  ASSERT_EQ(batch.boxes.size(), 1u);
  ASSERT_EQ(batch.pixels.size(), 1024u);
  for (std::size_t i = 0; i < batch.pixels.size(); ++i) ASSERT_EQ(batch.pixels[i], patternOf(update, i));
}

TEST(FrameBelt, HandsEveryBatchOverInOrderBetweenTwoThreads) {
  constexpr std::uint64_t kUpdates = 3000;
  std::atomic<int> wakes = 0;
  FrameBelt belt([&wakes] { ++wakes; });
  std::jthread producer([&belt](const std::stop_token& stop) {
    for (std::uint64_t update = 1; update <= kUpdates; ++update) {
      Batch* batch = belt.acquire(stop);
      if (batch == nullptr) return;
      fill(*batch, update);
      belt.publish(batch);
    }
  });
  std::mt19937 random(3);
  for (std::uint64_t update = 1; update <= kUpdates;) {
    Batch* batch = belt.take();
    if (batch == nullptr) {
      std::this_thread::yield();
      continue;
    }
    expectIntact(*batch, update);
    if (random() % 64 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    belt.release(batch);
    ++update;
  }
  EXPECT_EQ(belt.take(), nullptr);
  producer.join();
  EXPECT_EQ(wakes, static_cast<int>(kUpdates));
}

TEST(FrameBelt, HoldsTheProducerBackWhenFull) {
  FrameBelt belt(nullptr);
  const std::stop_source source;
  for (std::size_t i = 0; i < FrameBelt::kSlots; ++i) belt.publish(belt.acquire(source.get_token()));
  std::atomic<bool> got = false;
  std::jthread producer([&](const std::stop_token& stop) { got = belt.acquire(stop) != nullptr; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(got);
  belt.release(belt.take());
  producer.join();
  EXPECT_TRUE(got);
}

TEST(FrameBelt, LetsAStoppedProducerGo) {
  FrameBelt belt(nullptr);
  std::stop_source source;
  for (std::size_t i = 0; i < FrameBelt::kSlots; ++i) belt.publish(belt.acquire(source.get_token()));
  Batch* got = belt.take();
  std::jthread producer([&] { got = belt.acquire(source.get_token()); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  source.request_stop();
  producer.join();
  EXPECT_EQ(got, nullptr);
}

TEST(FrameBelt, ClearsABatchButKeepsItsMemory) {
  FrameBelt belt(nullptr);
  const std::stop_source source;
  for (std::size_t i = 0; i < FrameBelt::kSlots; ++i) {
    Batch* batch = belt.acquire(source.get_token());
    fill(*batch, 1);
    belt.publish(batch);
    belt.release(belt.take());
  }
  Batch* again = belt.acquire(source.get_token());
  EXPECT_TRUE(again->boxes.empty());
  EXPECT_TRUE(again->pixels.empty());
  EXPECT_FALSE(again->completesUpdate);
  EXPECT_GE(again->pixels.capacity(), 1024u);
}

}  // namespace
}  // namespace pixelflex::viewer
