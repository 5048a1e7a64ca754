#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "devices/image/image_error.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using devices::Image;
using devices::Image16;
using devices::Image8;
using devices::ImageError;
using devices::PngEffort;
using devices::readPng16;
using devices::readPng8;
using devices::writePng;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <class Sample>
Image<Sample> noise(devices::Size size, int channels) {
  Image<Sample> image(size, channels);
  std::mt19937 random(11);
  for (auto& sample : image.samples()) sample = static_cast<Sample>(random());
  return image;
}

std::string readAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeAll(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A PNG chunk: length, name, data, checksum.
std::string chunk(const std::string& nameAndData) {
  const auto number = [](std::uint64_t value) {
    std::string bytes;
    for (unsigned shift = 32; shift > 0; shift -= 8) bytes += static_cast<char>((value >> (shift - 8)) & 0xFFU);
    return bytes;
  };
  const auto crc =
      ::crc32(0, reinterpret_cast<const Bytef*>(nameAndData.data()), static_cast<uInt>(nameAndData.size()));
  return number(nameAndData.size() - 4) + nameAndData + number(crc);
}

/// A well-formed PNG file whose header promises any extent, with hardly any data.
std::string pngPromising(std::uint32_t width, std::uint32_t height) {
  std::string header = "IHDR";
  for (const std::uint32_t value : {width, height}) {
    for (unsigned shift = 32; shift > 0; shift -= 8) header += static_cast<char>((value >> (shift - 8)) & 0xFFU);
  }
  header += std::string("\x08\x02\x00\x00\x00", 5);
  return "\x89PNG\r\n\x1a\n" + chunk(header) + chunk("IDATx") + chunk("IEND");
}

class ImagePng : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "image.png"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(ImagePng, RoundTripsEveryNumberOfChannelsAndBothDepths) {
  for (int channels = 1; channels <= 4; ++channels) {
    for (const devices::Size size : {devices::Size{1, 1}, devices::Size{37, 5}, devices::Size{3, 300}}) {
      for (const PngEffort effort : {PngEffort::kFast, PngEffort::kSmall}) {
        const auto eight = noise<std::uint8_t>(size, channels);
        writePng(path(), eight, effort);
        EXPECT_EQ(readPng8(path()), eight);
        const auto sixteen = noise<std::uint16_t>(size, channels);
        writePng(path(), sixteen, effort);
        EXPECT_EQ(readPng16(path()), sixteen);
      }
    }
  }
}

TEST_F(ImagePng, WidensAndReducesBetweenTheDepths) {
  Image8 eight({256, 1}, 1);
  for (int x = 0; x < 256; ++x) eight.at(x, 0) = static_cast<std::uint8_t>(x);
  writePng(path(), eight);
  const Image16 widened = readPng16(path());
  for (int x = 0; x < 256; ++x) EXPECT_EQ(widened.at(x, 0), x * 257);
  Image16 sixteen({65536 / 8, 8}, 1);
  for (int v = 0; v < 65536; ++v) sixteen.at(v % 8192, v / 8192) = static_cast<std::uint16_t>(v);
  writePng(path(), sixteen);
  const Image8 reduced = readPng8(path());
  for (int v = 0; v < 65536; ++v) ASSERT_EQ(reduced.at(v % 8192, v / 8192), (v * 255 + 32895) >> 16) << v;
}

TEST_F(ImagePng, ATruncatedFileIsAnErrorWhereverItEnds) {
  const auto image = noise<std::uint8_t>({64, 48}, 3);
  writePng(path(), image);
  const std::string bytes = readAll(path());
  for (std::size_t part = 0; part < 16; ++part) {
    writeAll(path(), bytes.substr(0, bytes.size() * part / 16));
    EXPECT_THAT([&] { (void)readPng8(path()); }, ThrowsMessage<ImageError>(HasSubstr(path().string()))) << part;
    EXPECT_THAT([&] { (void)readPng16(path()); }, ThrowsMessage<ImageError>(HasSubstr(path().string()))) << part;
  }
}

TEST_F(ImagePng, ADamagedFileIsAnErrorOrAnImageButNothingWorse) {
  writePng(path(), noise<std::uint16_t>({64, 48}, 3));
  const std::string good = readAll(path());
  std::mt19937 random(5);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    writeAll(path(), bytes);
    try {
      EXPECT_FALSE(readPng16(path()).empty());
    } catch (const ImageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path().string()));
    }
  }
}

TEST_F(ImagePng, AHostileHeaderIsRefusedBeforeAnythingIsAllocated) {
  for (const auto& [width, height] :
       {std::pair(100'000U, 100'000U), std::pair(32'769U, 1U), std::pair(1U, 32'769U), std::pair(0U, 5U)}) {
    writeAll(path(), pngPromising(width, height));
    EXPECT_THROW((void)readPng8(path()), ImageError) << width << "x" << height;
  }
}

TEST_F(ImagePng, AHeaderThatPromisesTooMuchIsRefused) {
  writeAll(path(), pngPromising(16'385, 16'384));
  EXPECT_THAT([&] { (void)readPng16(path()); }, ThrowsMessage<ImageError>(HasSubstr("more than 2^28 pixels")));
  writeAll(path(), pngPromising(8'192, 8'192));
  EXPECT_THAT([&] { (void)readPng16(path()); }, ThrowsMessage<ImageError>(HasSubstr("than the file can hold")));
}

TEST_F(ImagePng, ALargeEmptyPictureIsNotTakenForAFalsePromise) {
  for (const PngEffort effort : {PngEffort::kFast, PngEffort::kSmall}) {
    writePng(path(), Image8({4000, 3000}, 1), effort);
    EXPECT_EQ(readPng8(path()), Image8({4000, 3000}, 1));
  }
}

TEST_F(ImagePng, OtherFilesAreRefused) {
  EXPECT_THAT([&] { (void)readPng8(path()); }, ThrowsMessage<ImageError>(HasSubstr("cannot open: No such file")));
  writeAll(path(), "");
  EXPECT_THAT([&] { (void)readPng8(path()); }, ThrowsMessage<ImageError>(HasSubstr("the file is empty")));
  writeAll(path(), "This is a text, not a picture.\n");
  EXPECT_THAT([&] { (void)readPng8(path()); }, ThrowsMessage<ImageError>(HasSubstr("not a PNG file")));
  std::filesystem::remove(path());
  std::filesystem::create_directory(path());
  EXPECT_THROW((void)readPng8(path()), ImageError);
}

TEST_F(ImagePng, WhatCannotBeWrittenIsRefused) {
  EXPECT_THROW(writePng(path(), Image8()), ImageError);
  writeAll(path(), "x");
  EXPECT_THAT(
      [&] {
        writePng(path() / "below.png", Image8({2, 2}, 1));
      },
      ThrowsMessage<ImageError>(HasSubstr(path().string())));
}

TEST(ImageSize, CountsPixelsInSixtyFourBits) {
  EXPECT_EQ((devices::Size{65536, 65536}).area(), std::int64_t{1} << 32U);
}

TEST(ImageValue, RefusesExtentsAndChannelsThatMakeNoSense) {
  EXPECT_THROW(Image8({0, 1}, 1), std::invalid_argument);
  EXPECT_THROW(Image8({1, -1}, 1), std::invalid_argument);
  EXPECT_THROW(Image8({1, 1}, 0), std::invalid_argument);
  EXPECT_THROW(Image8({1, 1}, 5), std::invalid_argument);
}

}  // namespace
}  // namespace pixelflex::testing
