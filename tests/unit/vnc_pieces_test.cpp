#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "viewer/vnc/input_queue.h"
#include "viewer/vnc/rfb_cursor.h"
#include "viewer/vnc/text_encoding.h"
#include "viewer/vnc/update_publisher.h"

namespace pixelflex::viewer {
namespace {

TEST(InputQueue, ReplacesAMotionByTheNext) {
  InputQueue queue;
  for (int x = 1; x <= 5; ++x) queue.add(PointerInput{x, 0, 0});
  EXPECT_EQ(queue.takeAll(), (std::vector<Input>{PointerInput{5, 0, 0}}));
  EXPECT_TRUE(queue.takeAll().empty());
}

TEST(InputQueue, KeepsWhereAButtonGoesDownAndUp) {
  InputQueue queue;
  queue.add(PointerInput{1, 1, 0});
  queue.add(PointerInput{2, 2, 0});
  queue.add(PointerInput{2, 2, 1});
  for (int x = 3; x <= 9; ++x) queue.add(PointerInput{x, x, 1});
  queue.add(PointerInput{9, 9, 0});
  queue.add(PointerInput{10, 10, 0});
  EXPECT_EQ(queue.takeAll(), (std::vector<Input>{PointerInput{2, 2, 0}, PointerInput{2, 2, 1}, PointerInput{9, 9, 1},
                                                 PointerInput{9, 9, 0}, PointerInput{10, 10, 0}}));
}

TEST(InputQueue, KeepsAPressThatIsNewSinceTheLastTake) {
  InputQueue queue;
  queue.add(PointerInput{1, 1, 0});
  (void)queue.takeAll();
  queue.add(PointerInput{1, 1, 1});
  queue.add(PointerInput{5, 5, 1});
  EXPECT_EQ(queue.takeAll(), (std::vector<Input>{PointerInput{1, 1, 1}, PointerInput{5, 5, 1}}));
}

TEST(InputQueue, KeepsTheOrderAroundKeys) {
  InputQueue queue;
  queue.add(PointerInput{1, 1, 0});
  queue.add(KeyInput{'a', true});
  queue.add(PointerInput{2, 2, 0});
  queue.add(ClipboardInput{"marked", Selection::kPrimary});
  queue.add(ClipboardInput{"old"});
  queue.add(ClipboardInput{"new"});
  EXPECT_EQ(queue.takeAll(),
            (std::vector<Input>{PointerInput{1, 1, 0}, KeyInput{'a', true}, PointerInput{2, 2, 0},
                                ClipboardInput{"marked", Selection::kPrimary}, ClipboardInput{"new"}}));
}

TEST(TextEncoding, GoesBetweenLatin1AndUtf8) {
  EXPECT_EQ(utf8FromLatin1("h\xe9llo \xff"), "héllo ÿ");
  EXPECT_EQ(latin1FromUtf8("héllo ÿ"), "h\xe9llo \xff");
  EXPECT_EQ(latin1FromUtf8("a→b😀c"), "a?b?c");
  std::string all;
  for (int c = 0; c < 256; ++c) all.push_back(static_cast<char>(c));
  EXPECT_EQ(latin1FromUtf8(utf8FromLatin1(all)), all);
}

TEST(TextEncoding, SurvivesMalformedUtf8) {
  EXPECT_EQ(latin1FromUtf8("a\xc3"), "a?");
  EXPECT_EQ(latin1FromUtf8("\xc0\xaf"), "??");            // over-long
  EXPECT_EQ(latin1FromUtf8("\xed\xa0\x80"), "???");       // surrogate
  EXPECT_EQ(latin1FromUtf8("\xf5\x80\x80\x80"), "????");  // beyond Unicode
  EXPECT_EQ(utf8FromEither("wall \xe9"), "wall é");
  EXPECT_EQ(utf8FromEither("wall é"), "wall é");
}

TEST(Cursor, TakesAlphaFromTheMask) {
  const std::vector<std::uint8_t> colours{1, 2, 3, 99, 4, 5, 6, 99};
  const std::vector<std::uint8_t> mask{1, 0};
  EXPECT_EQ(cursorFromMask({2, 1}, colours, mask).rgba, (std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 0}));
}

TEST(Cursor, DividesPremultipliedColours) {
  const std::vector<std::uint8_t> premultiplied{64, 128, 0, 128, 0, 0, 0, 0, 200, 100, 50, 255, 255, 9, 9, 10};
  EXPECT_EQ(cursorFromPremultiplied({4, 1}, premultiplied).rgba,
            (std::vector<std::uint8_t>{128, 255, 0, 128, 0, 0, 0, 0, 200, 100, 50, 255, 255, 230, 230, 10}));
}

std::vector<std::byte> numberedPixels(devices::Size size) {
  std::vector<std::byte> pixels(static_cast<std::size_t>(size.area()) * 4);
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const auto number = static_cast<std::uint32_t>(i / 4);
    std::memcpy(&pixels[i], &number, 4);
  }
  return pixels;
}

// Every pixel of a batch is the one at its place.
void expectPixels(const Batch& batch) {
  std::size_t at = 0;
  std::int64_t wrong = 0;
  for (const Box& box : batch.boxes) {
    for (std::int64_t i = 0; i < box.area(); ++i, at += 4) {
      std::uint32_t number = 0;
      std::memcpy(&number, &batch.pixels.at(at), 4);
      const std::int64_t x = box.left + i % box.width();
      const std::int64_t y = box.top + i / box.width();
      wrong += number != y * batch.desktop.width + x ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(at, batch.pixels.size());
}

// Takes batches until one completes the update, and says how many pixels they hold.
std::int64_t takeUpdate(FrameBelt& belt, devices::Size desktop, std::uint64_t serial) {
  std::int64_t area = 0;
  for (bool complete = false; !complete;) {
    Batch* batch = belt.take();
    if (batch == nullptr) {
      std::this_thread::yield();
      continue;
    }
    EXPECT_EQ(batch->desktop, desktop);
    EXPECT_EQ(batch->update, serial);
    EXPECT_LE(batch->pixels.size(), FrameBelt::kMaxBytes);
    expectPixels(*batch);
    area += static_cast<std::int64_t>(batch->pixels.size() / 4);
    complete = batch->completesUpdate;
    belt.release(batch);
  }
  return area;
}

TEST(UpdatePublisher, CutsALargeUpdateIntoBoundedBatches) {
  const devices::Size desktop{4001, 3003};  // 48 MB, rows that do not divide a batch
  const std::vector<std::byte> pixels = numberedPixels(desktop);
  FrameBelt belt(nullptr);
  std::jthread producer([&](const std::stop_token& stop) {
    Update update{9, {}, {}};
    update.damage.add(boxOf(desktop));
    EXPECT_TRUE(publishUpdate({pixels, desktop}, update, belt, stop));
  });
  EXPECT_EQ(takeUpdate(belt, desktop, 9), desktop.area());
}

TEST(UpdatePublisher, CopiesEveryBoxOfRandomDamage) {
  const devices::Size desktop{700, 500};
  const std::vector<std::byte> pixels = numberedPixels(desktop);
  std::mt19937 random(11);
  FrameBelt belt(nullptr);
  for (std::uint64_t serial = 1; serial <= 50; ++serial) {
    Update update{serial, {}, {}};
    for (int i = 0; i < 20; ++i) {
      const int left = static_cast<int>(random() % 690);
      const int top = static_cast<int>(random() % 490);
      update.damage.add(intersect({left, top, left + 1 + static_cast<int>(random() % 60), top + 10}, boxOf(desktop)));
    }
    ASSERT_TRUE(publishUpdate({pixels, desktop}, update, belt, {}));
    ASSERT_EQ(takeUpdate(belt, desktop, serial), update.damage.area());
  }
}

TEST(UpdatePublisher, PublishesNothingForNoDamage) {
  FrameBelt belt(nullptr);
  EXPECT_TRUE(publishUpdate({}, {}, belt, {}));
  EXPECT_EQ(belt.take(), nullptr);
}

TEST(UpdatePublisher, StopsInTheMiddleOfALargeUpdate) {
  const devices::Size desktop{4096, 8192};
  const std::vector<std::byte> pixels(static_cast<std::size_t>(desktop.area()) * 4);
  FrameBelt belt(nullptr);
  std::stop_source source;
  std::jthread producer([&] {
    Update update{1, {}, {}};
    update.damage.add(boxOf(desktop));
    EXPECT_FALSE(publishUpdate({pixels, desktop}, update, belt, source.get_token()));
  });
  while (belt.take() == nullptr) std::this_thread::yield();
  source.request_stop();
}

}  // namespace
}  // namespace pixelflex::viewer
