#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "devices/image/exposure_time.h"
#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_image/jpeg.h"

namespace pixelflex::testing {
namespace {

using devices::Image16;
using devices::Image8;
using devices::ImageError;
using devices::readPhoto;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A smooth picture, which JPEG keeps almost unchanged.
Image8 gradient(devices::Size size, int channels) {
  Image8 image(size, channels);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(40 + (c == 0 ? x : c == 1 ? y : (x + y) / 2));
      }
    }
  }
  return image;
}

std::string jpegFile(const Image8& image) {
  const auto bytes = jpegOf(image);
  return {bytes.begin(), bytes.end()};
}

class ImagePhoto : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "photo"; }
  void write(const std::string& bytes) const { std::ofstream(path(), std::ios::binary) << bytes; }

 private:
  TemporaryFolder folder_;
};

TEST_F(ImagePhoto, ReadsAJpegByItsContent) {
  const Image8 image = gradient({128, 96}, 3);
  write(jpegFile(image));
  const Image8 photo = readPhoto(path());
  ASSERT_EQ(photo.size(), image.size());
  ASSERT_EQ(photo.channels(), 3);
  for (std::size_t i = 0; i < image.samples().size(); ++i) ASSERT_NEAR(photo.samples()[i], image.samples()[i], 8) << i;
}

TEST_F(ImagePhoto, SpreadsAGreyJpeg) {
  const Image8 image = gradient({64, 32}, 1);
  write(jpegFile(image));
  const Image8 photo = readPhoto(path());
  ASSERT_EQ(photo.channels(), 3);
  for (int x = 0; x < 64; ++x) {
    EXPECT_NEAR(photo.at(x, 9, 0), image.at(x, 9), 3);
    EXPECT_EQ(photo.at(x, 9, 0), photo.at(x, 9, 1));
    EXPECT_EQ(photo.at(x, 9, 0), photo.at(x, 9, 2));
  }
}

TEST_F(ImagePhoto, ReadsEveryKindOfPngAsThreeChannels) {
  for (int channels = 1; channels <= 4; ++channels) {
    const Image8 image = gradient({20, 10}, channels);
    devices::writePng(path(), image);
    const Image8 photo = readPhoto(path());
    ASSERT_EQ(photo.channels(), 3);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(photo.at(7, 3, c), image.at(7, 3, channels >= 3 ? c : 0));
  }
  Image16 deep({2, 1}, 1);
  deep.at(1, 0) = 0x80FF;
  devices::writePng(path(), deep);
  EXPECT_EQ(readPhoto(path()).at(1, 0, 2), 0x80);
}

TEST_F(ImagePhoto, ATruncatedJpegIsAnErrorWhereverItEnds) {
  const std::string bytes = jpegFile(gradient({128, 96}, 3));
  for (std::size_t part = 0; part < 16; ++part) {
    write(bytes.substr(0, bytes.size() * part / 16));
    EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr(path().string()))) << part;
  }
  write(bytes.substr(0, bytes.size() - 2));
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("damaged JPEG"))) << "the end mark";
}

TEST_F(ImagePhoto, ADamagedJpegIsAnErrorOrAnImageButNothingWorse) {
  const std::string good = jpegFile(gradient({128, 96}, 3));
  std::mt19937 random(6);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    write(bytes);
    try {
      EXPECT_EQ(readPhoto(path()).channels(), 3);
    } catch (const ImageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path().string()));
    }
  }
}

TEST_F(ImagePhoto, AJpegThatPromisesTooMuchIsRefused) {
  std::string bytes = jpegFile(gradient({16, 16}, 3));
  const std::size_t frame = bytes.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\xff\xff\xff\xff");
  write(bytes);
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr(path().string())));
  bytes.replace(frame + 5, 4, "\x80\x01\x80\x01");
  write(bytes);
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("32768")));
  bytes.replace(frame + 5, 4, "\x40\x01\x40\x01");
  write(bytes);
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("more than 2^28 pixels")));
  bytes.replace(frame + 5, 4, "\x20\x01\x20\x01");
  write(bytes);
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("than the file can hold")));
}

TEST_F(ImagePhoto, OtherFilesAreRefused) {
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("cannot open")));
  write("");
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("the file is empty")));
  write("Not a photograph.");
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("neither a PNG nor a JPEG")));
  write("\xff");
  EXPECT_THAT([&] { (void)readPhoto(path()); }, ThrowsMessage<ImageError>(HasSubstr("neither a PNG nor a JPEG")));
}

/// A JPEG's Exif with the exposure `above` / `below`, in either byte order; `speed`: its shutter speed, in hundredths
/// of a power of two.
std::string exifOf(std::uint32_t above, std::uint32_t below, bool bigEndian, std::int32_t speed = 1000'00) {
  std::string tiff;
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const int shift = 8 * (bigEndian ? bytes - 1 - i : i);
      tiff += static_cast<char>((value >> shift) & 0xFFU);
    }
  };
  tiff = bigEndian ? "MM" : "II";
  put(42, 2), put(8, 4);
  put(2, 2);                                                   // the first directory, at 8
  put(0x0112, 2), put(3, 2), put(1, 4), put(1, 2), put(0, 2);  // orientation
  put(0x8769, 2), put(4, 2), put(1, 4), put(38, 4);            // where the next one is
  put(0, 4);
  put(2, 2);  // Exif, at 38
  put(0x829A, 2), put(5, 2), put(1, 4), put(68, 4);
  put(0x9201, 2), put(10, 2), put(1, 4), put(76, 4);
  put(0, 4);
  put(above, 4), put(below, 4);                            // at 68
  put(static_cast<std::uint32_t>(speed), 4), put(100, 4);  // at 76
  const std::string body = std::string("Exif\0\0", 6) + tiff;
  const auto length = static_cast<unsigned>(body.size() + 2);
  return std::string("\xFF\xE1") + static_cast<char>(length >> 8U) + static_cast<char>(length & 0xFFU) + body;
}

class ExposureTimeTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::optional<double> timeOf(const std::string& bytes) const {
    const auto file = folder_ / "photo.jpg";
    std::ofstream(file, std::ios::binary) << bytes;
    return devices::exposureTime(file);
  }
  const std::string jpeg_ = jpegFile(gradient({16, 16}, 3));
  TemporaryFolder folder_;
};

TEST_F(ExposureTimeTest, IsReadFromExif) {
  for (const bool bigEndian : {false, true}) {
    std::string bytes = jpeg_;
    bytes.insert(2, exifOf(1, 60, bigEndian));
    EXPECT_NEAR(timeOf(bytes).value_or(0), 1.0 / 60, 1e-12);
    EXPECT_EQ(readPhoto(folder_ / "photo.jpg").width(), 16);
  }
}

TEST_F(ExposureTimeTest, IsTheShutterSpeedWhereItWasRounded) {
  const auto timeWith = [&](std::uint32_t above, std::uint32_t below, std::int32_t speed) {
    return timeOf(std::string(jpeg_).insert(2, exifOf(above, below, true, speed))).value_or(0);
  };
  EXPECT_NEAR(timeWith(1, 60, 600), 1.0 / 64, 1e-12);
  EXPECT_NEAR(timeWith(30, 1, -500), 32, 1e-9);
  EXPECT_NEAR(timeWith(1, 60, 0), 1.0 / 60, 1e-12) << "a shutter speed that was not filled in";
}

TEST_F(ExposureTimeTest, IsAbsentWhereNothingIsSaid) {
  EXPECT_FALSE(timeOf(jpeg_));
  EXPECT_FALSE(timeOf(""));
  EXPECT_FALSE(timeOf("\x89PNG"));
  EXPECT_FALSE(devices::exposureTime(folder_ / "nowhere.jpg"));
  std::string bytes = jpeg_;
  EXPECT_FALSE(timeOf(bytes.insert(2, exifOf(0, 60, true))));
  bytes = jpeg_;
  EXPECT_FALSE(timeOf(bytes.insert(2, exifOf(1, 0, true))));
}

TEST_F(ExposureTimeTest, DamagedFilesDoNoHarm) {
  std::mt19937 random(std::random_device{}());
  const std::string whole = std::string(jpeg_).insert(2, exifOf(1, 60, false));
  for (int i = 0; i < 500; ++i) {
    std::string bytes = whole.substr(0, random() % 120);
    for (int k = 0; k < 3 && bytes.size() > 2; ++k)
      bytes[2 + random() % (bytes.size() - 2)] = static_cast<char>(random());
    const auto time = timeOf(bytes);
    EXPECT_TRUE(!time || *time > 0);
  }
}

}  // namespace
}  // namespace pixelflex::testing
