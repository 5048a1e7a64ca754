#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support_image/jpeg.h"
#include "viewer/vnc/jpeg_rect.h"
#include "viewer/vnc/jpeg_workers.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;

constexpr devices::Size kSize{48, 32};

std::uint8_t sample(int x, int y, int channel) {
  return static_cast<std::uint8_t>(channel == 0 ? 5 * x : channel == 1 ? 7 * y : 200 - 3 * x);
}

// A smooth picture, or a shifted one, encoded as servers do.
std::vector<std::uint8_t> encoded(devices::Size size, int shift = 0) {
  devices::Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = sample(x + shift, y, c);
    }
  }
  return pixelflex::testing::jpegOf(image);
}

TEST(JpegRect, WritesItsRowsAndNothingElse) {
  constexpr std::size_t kRow = 4 * 60;  // of a desktop that is wider
  std::vector<std::uint8_t> out(kRow * 34, 77);
  ASSERT_TRUE(decodeJpegRect(encoded(kSize), kSize, &out[kRow + 20], kRow));
  for (std::size_t y = 0; y < 34; ++y) {
    for (std::size_t x = 0; x < 60; ++x) {
      const bool inside = x >= 5 && x < 53 && y >= 1 && y < 33;
      for (std::size_t c = 0; c < 3; ++c) {
        const int expected =
            inside ? sample(static_cast<int>(x) - 5, static_cast<int>(y) - 1, static_cast<int>(c)) : 77;
        ASSERT_NEAR(out[y * kRow + 4 * x + c], expected, inside ? 12 : 0) << x << ", " << y;
      }
    }
  }
}

TEST(JpegRect, RefusesAnotherSizeAndWhatIsNoJpeg) {
  std::vector<std::uint8_t> out(std::size_t{4} * 48 * 32, 77);
  const std::vector<std::uint8_t> untouched = out;
  for (const devices::Size size : {devices::Size{47, 32}, {48, 31}, {24, 16}, {4096, 4096}, {65000, 1}}) {
    EXPECT_FALSE(decodeJpegRect(encoded(size), kSize, out.data(), 4 * 48)) << size.width;
  }
  EXPECT_FALSE(decodeJpegRect({}, kSize, out.data(), 4 * 48));
  EXPECT_FALSE(decodeJpegRect(std::vector<std::uint8_t>(500, 0xff), kSize, out.data(), 4 * 48));
  EXPECT_EQ(out, untouched);
}

// Markers whose length lies, wherever they are.
TEST(JpegRect, StaysInsideADamagedPicture) {
  const std::vector<std::uint8_t> whole = encoded(kSize);
  std::vector<std::uint8_t> out(std::size_t{4} * 48 * 32);
  for (std::size_t i = 2; i < whole.size(); ++i) {
    std::vector<std::uint8_t> jpeg = whole;
    jpeg[i] = 0xff;
    (void)decodeJpegRect(jpeg, kSize, out.data(), 4 * 48);
    jpeg.resize(i);
    (void)decodeJpegRect(jpeg, kSize, out.data(), 4 * 48);
  }
}

Message jpegRect(int x, int y, devices::Size size, const std::vector<std::uint8_t>& jpeg) {
  Message rect = Message().rect(x, y, size.width, size.height, kTightEncoding).u8(0x90);
  const auto bytes = static_cast<std::uint32_t>(jpeg.size());
  rect.u8(0x80 | (bytes & 0x7f));
  if (bytes < (1u << 14)) {
    rect.u8(bytes >> 7);
  } else {
    rect.u8(0x80 | ((bytes >> 7) & 0x7f)).u8(bytes >> 14);
  }
  for (const std::uint8_t byte : jpeg) rect.u8(byte);
  return rect;
}

TEST(JpegRect, IsShownBySessions) {
  const Message update = Message().update(1).append(jpegRect(10, 4, kSize, encoded(kSize)));
  const FakeVncServer server([&update](FakeConnection& client) {
    client.shakeHands({64, 48});
    client.send(update);
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mirror.desktop().at(10 + 20, 4 + 9, c), sample(20, 9, c), 12);
  EXPECT_EQ(mirror.bytes(), 4u * 48 * 32);
  EXPECT_EQ(mirror.desktop().size(), (devices::Size{64, 48}));
}

/// What an update leaves when its rectangles are done one after the other.
class InOrder {
 public:
  static constexpr devices::Size kDesktop{512, 640};
  static constexpr devices::Size kLarge{256, 128};
  static_assert(kLarge.width * kLarge.height >= JpegWorkers::kWorthwhilePixels);

  InOrder() { std::ranges::fill(pixels_, std::uint8_t{0}); }

  void jpeg(int x, int y, int shift) {
    const auto picture = encoded(kLarge, shift);
    ASSERT_TRUE(decodeJpegRect(picture, kLarge, &pixels_[at(x, y)], kRow));
    add(jpegRect(x, y, kLarge, picture));
  }
  void copy(int x, int y, devices::Size size, int fromX, int fromY) {
    const auto before = pixels_;
    for (int row = 0; row < size.height; ++row) {
      const auto from = before.begin() + static_cast<std::ptrdiff_t>(at(fromX, fromY + row));
      std::copy_n(from, 4 * size.width, pixels_.begin() + static_cast<std::ptrdiff_t>(at(x, y + row)));
    }
    const auto u = [](int value) { return static_cast<std::uint32_t>(value); };
    add(Message().rect(x, y, size.width, size.height, kCopyRectEncoding).u16(u(fromX)).u16(u(fromY)));
  }
  void raw(int x, int y, devices::Size size, std::uint8_t grey) {
    for (int row = 0; row < size.height; ++row) std::fill_n(&pixels_[at(x, y + row)], 4 * size.width, grey);
    const auto bytes = static_cast<std::size_t>(4 * size.area());
    add(Message().rect(x, y, size.width, size.height, kRawEncoding).repeat(grey, bytes));
  }

  /// Of all rectangles; or with more to come.
  [[nodiscard]] Message update(std::uint32_t more = 0) const {
    return Message().update(count_ + more).append(rectangles_);
  }
  [[nodiscard]] std::uint8_t sampleAt(int x, int y, int channel) const {
    return pixels_[at(x, y) + static_cast<std::size_t>(channel)];
  }

 private:
  static constexpr std::size_t kRow = std::size_t{4} * kDesktop.width;
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * kRow + 4 * static_cast<std::size_t>(x); }
  void add(const Message& rectangle) {
    rectangles_.append(rectangle);
    ++count_;
  }

  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kRow * kDesktop.height);
  Message rectangles_;
  std::uint32_t count_ = 0;
};

TEST(JpegRect, LargeOnesAreAsIfDecodedInOrder) {
  InOrder desktop;
  for (int round = 0; round < 8; ++round) {
    for (int y = 0; y <= 512; y += 128) {
      desktop.jpeg(0, y, 3 * round + y);
      desktop.jpeg(256, y, 5 * round - y);
    }
    desktop.copy(100, 40, {300, 500}, 90, 60);  // from what is being decoded, over itself
    desktop.jpeg(200, 300, 90 * round);         // over what was just copied
    desktop.raw(190, 290, {40, 30}, static_cast<std::uint8_t>(20 * round));
    desktop.jpeg(195, 310, 7 * round);
    desktop.copy(0, 0, {512, 200}, 0, 400);
  }
  const FakeVncServer server([&desktop](FakeConnection& client) {
    client.shakeHands(InOrder::kDesktop);
    client.send(desktop.update());
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() == 1; })) << mirror.summary();
  for (int y = 0; y < InOrder::kDesktop.height; ++y) {
    for (int x = 0; x < InOrder::kDesktop.width; ++x) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(mirror.desktop().at(x, y, c), desktop.sampleAt(x, y, c)) << x << ", " << y;
    }
  }
}

TEST(JpegRect, ALargeOneThatIsDamagedEndsTheSession) {
  auto picture = encoded(InOrder::kLarge);
  std::fill(picture.begin() + 2, picture.begin() + 200, std::uint8_t{0xff});
  const FakeVncServer server([&picture](FakeConnection& client) {
    client.shakeHands(InOrder::kDesktop);
    client.send(Message().update(1).append(jpegRect(0, 0, InOrder::kLarge, picture)));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kProtocol);
  EXPECT_THAT(mirror.last<Closed>()->message, ::testing::HasSubstr("JPEG picture is damaged"));
  EXPECT_EQ(mirror.updates(), 0u);
}

TEST(JpegRect, ASessionEndsWithPicturesHalfDone) {
  InOrder desktop;
  for (int y = 0; y <= 512; y += 128) desktop.jpeg(0, y, y);
  for (int round = 0; round < 10; ++round) {
    const FakeVncServer server([&desktop](FakeConnection& client) {
      client.shakeHands(InOrder::kDesktop);
      client.send(desktop.update(1));
    });
    DesktopMirror mirror(server.address());
    ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  }
}

}  // namespace
}  // namespace pixelflex::viewer
