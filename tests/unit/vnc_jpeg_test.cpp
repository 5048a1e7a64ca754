#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <vector>
// Needs <cstdio> before it.
#include <jpeglib.h>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/jpeg_rect.h"
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

// A smooth picture, encoded as servers do.
std::vector<std::uint8_t> encoded(devices::Size size) {
  jpeg_error_mgr errors{};
  jpeg_compress_struct encoder{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  jpeg_mem_dest(&encoder, &bytes, &count);
  encoder.image_width = static_cast<JDIMENSION>(size.width);
  encoder.image_height = static_cast<JDIMENSION>(size.height);
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, 98, TRUE);
  jpeg_start_compress(&encoder, TRUE);
  for (int y = 0; y < size.height; ++y) {
    std::vector<std::uint8_t> row;
    for (int i = 0; i < 3 * size.width; ++i) row.push_back(sample(i / 3, y, i % 3));
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&encoder, &pointer, 1);
  }
  jpeg_finish_compress(&encoder);
  jpeg_destroy_compress(&encoder);
  std::vector<std::uint8_t> jpeg(bytes, bytes + count);
  std::free(bytes);
  return jpeg;
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

TEST(JpegRect, IsShownBySessions) {
  const std::vector<std::uint8_t> jpeg = encoded(kSize);
  Message update = Message().update(1).rect(10, 4, kSize.width, kSize.height, kTightEncoding).u8(0x90);
  update.u8(0x80 | (jpeg.size() & 0x7f)).u8(static_cast<std::uint32_t>(jpeg.size() >> 7));
  for (const std::uint8_t byte : jpeg) update.u8(byte);
  ASSERT_LT(jpeg.size(), 1u << 14) << "the length takes two bytes";
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

}  // namespace
}  // namespace pixelflex::viewer
