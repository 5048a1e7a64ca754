#include "devices/image/photo_file.h"

#include <cstdio>
// jpeglib.h needs FILE and size_t declared before it.
#include <jpeglib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "devices/image/image_error.h"
#include "devices/image/png_file.h"

namespace pixelflex::devices {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File openForReading(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rbe"), &std::fclose);
  if (file == nullptr) throw ImageError(path.string() + ": cannot open: " + std::strerror(errno));
  return file;
}

[[noreturn]] void throwJpegError(j_common_ptr info) {
  std::array<char, JMSG_LENGTH_MAX> message{};
  (*info->err->format_message)(info, message.data());
  throw std::runtime_error(message.data());
}

// Level -1 is a warning about corrupt data, e.g. "premature end of file", after which libjpeg would fill with grey.
void throwOnCorruption(j_common_ptr info, int level) {
  if (level < 0) throwJpegError(info);
}

class JpegReader {
 public:
  JpegReader() {
    info_.err = jpeg_std_error(&errors_);
    errors_.error_exit = throwJpegError;
    errors_.emit_message = throwOnCorruption;
    jpeg_create_decompress(&info_);
  }
  ~JpegReader() { jpeg_destroy_decompress(&info_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  [[nodiscard]] jpeg_decompress_struct& info() { return info_; }

 private:
  jpeg_decompress_struct info_{};
  jpeg_error_mgr errors_{};
};

/// At best a block of 64 pixels takes two bits in each component, and the colours are halved both ways.
constexpr std::uintmax_t kMaxPixelsPerByte = 1024;

/// From the source that the reader has.
Image8 decodeJpeg(JpegReader& reader, std::uintmax_t fileBytes) {
  auto& info = reader.info();
  jpeg_read_header(&info, TRUE);
  checkPromisedSize(info.image_width, info.image_height, fileBytes * kMaxPixelsPerByte);
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  Image8 image({static_cast<int>(info.output_width), static_cast<int>(info.output_height)}, 3);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = image.row(static_cast<int>(info.output_scanline)).data();
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return image;
}

Image8 toRgb(const Image8& image) {
  if (image.channels() == 3) return image;
  Image8 rgb(image.size(), 3);
  const int step = image.channels();
  for (int y = 0; y < image.height(); ++y) {
    const auto source = image.row(y);
    const auto target = rgb.row(y);
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width()); ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        target[3 * x + c] = source[x * static_cast<std::size_t>(step) + (step >= 3 ? c : 0)];
      }
    }
  }
  return rgb;
}

}  // namespace

Image8 readPhoto(const std::filesystem::path& path) {
  const File file = openForReading(path);
  std::array<unsigned char, 8> start{};
  const std::size_t count = std::fread(start.data(), 1, start.size(), file.get());
  if (count == 0) throw ImageError(path.string() + ": the file is empty");
  if (start[0] == 0xFF && start[1] == 0xD8) {
    std::rewind(file.get());
    try {
      JpegReader reader;
      jpeg_stdio_src(&reader.info(), file.get());
      return decodeJpeg(reader, std::filesystem::file_size(path));
    } catch (const std::exception& error) {
      throw ImageError(path.string() + ": damaged JPEG: " + error.what());
    }
  }
  if (start[0] == 0x89 && start[1] == 'P') return toRgb(readPng8(path));
  throw ImageError(path.string() + ": neither a PNG nor a JPEG file");
}

Image8 readJpeg(std::span<const std::uint8_t> bytes) {
  try {
    JpegReader reader;
    jpeg_mem_src(&reader.info(), bytes.data(), static_cast<unsigned long>(bytes.size()));
    return decodeJpeg(reader, bytes.size());
  } catch (const std::exception& error) {
    throw ImageError(std::string("damaged JPEG: ") + error.what());
  }
}

}  // namespace pixelflex::devices
