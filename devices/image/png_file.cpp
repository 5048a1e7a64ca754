#include "devices/image/png_file.h"

#include <png.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "devices/image/atomic_file.h"
#include "devices/image/image_error.h"

namespace pixelflex::devices {
namespace {

// libpng reports errors through a callback that must not return. Throwing from it is safe: both structures are owned by
// objects on this stack, and Debian builds libpng with unwind tables.
[[noreturn]] void throwPngError(png_structp, png_const_charp message) {
  throw std::runtime_error(message);
}
void ignorePngWarning(png_structp, png_const_charp) {}

class PngReader {
 public:
  PngReader() : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, throwPngError, ignorePngWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  [[nodiscard]] png_structp png() const { return png_; }
  [[nodiscard]] png_infop info() const { return info_; }

 private:
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

class PngWriter {
 public:
  PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throwPngError, ignorePngWarning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  [[nodiscard]] png_structp png() const { return png_; }
  [[nodiscard]] png_infop info() const { return info_; }

 private:
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// Bytes that deflate packs into one at best.
constexpr std::uintmax_t kMaxDeflation = 1032;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

void checkSignature(std::FILE* file) {
  std::array<png_byte, 8> signature{};
  const std::size_t count = std::fread(signature.data(), 1, signature.size(), file);
  if (count == 0) throw std::runtime_error("the file is empty");
  if (count < signature.size() || png_sig_cmp(signature.data(), 0, signature.size()) != 0) {
    throw std::runtime_error("not a PNG file");
  }
}

template <class Sample>
Image<Sample> decode(std::FILE* file, std::uintmax_t fileBytes) {
  checkSignature(file);
  const PngReader reader;
  png_structp png = reader.png();
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // ours come with a clearer message
  png_init_io(png, file);
  png_set_sig_bytes(png, 8);
  png_read_info(png, reader.info());
  const unsigned bitsPerPixel = png_get_channels(png, reader.info()) * unsigned{png_get_bit_depth(png, reader.info())};
  checkPromisedSize(png_get_image_width(png, reader.info()), png_get_image_height(png, reader.info()),
                    fileBytes * kMaxDeflation * 8 / bitsPerPixel);
  png_set_expand(png);
  if constexpr (sizeof(Sample) == 1) {
    png_set_scale_16(png);
  } else {
    png_set_expand_16(png);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  }
  png_set_interlace_handling(png);
  png_read_update_info(png, reader.info());
  Image<Sample> image({static_cast<int>(png_get_image_width(png, reader.info())),
                       static_cast<int>(png_get_image_height(png, reader.info()))},
                      png_get_channels(png, reader.info()));
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) rows.push_back(reinterpret_cast<png_bytep>(image.row(y).data()));
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  return image;
}

template <class Sample>
Image<Sample> read(const std::filesystem::path& path) {
  const File file(std::fopen(path.c_str(), "rbe"), &std::fclose);
  if (file == nullptr) throw ImageError(path.string() + ": cannot open: " + std::strerror(errno));
  try {
    return decode<Sample>(file.get(), std::filesystem::file_size(path));
  } catch (const std::exception& error) {
    throw ImageError(path.string() + ": " + error.what());
  }
}

int pngColourType(int channels) {
  constexpr std::array kTypes = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA};
  return kTypes.at(static_cast<std::size_t>(channels - 1));
}

void appendBytes(png_structp png, png_bytep data, std::size_t length) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + length);
}

template <class Sample>
std::vector<std::byte> encode(const Image<Sample>& image, PngEffort effort) {
  std::vector<std::byte> bytes;
  const PngWriter writer;
  png_structp png = writer.png();
  png_set_write_fn(png, &bytes, appendBytes, nullptr);
  png_set_user_limits(png, kMaxImageExtent, kMaxImageExtent);
  png_set_compression_level(png, effort == PngEffort::kFast ? 1 : 6);
  if (effort == PngEffort::kFast) png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, writer.info(), static_cast<png_uint_32>(image.width()), static_cast<png_uint_32>(image.height()),
               static_cast<int>(sizeof(Sample)) * 8, pngColourType(image.channels()), PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, writer.info());
  if constexpr (sizeof(Sample) == 2 && std::endian::native == std::endian::little) png_set_swap(png);
  for (int y = 0; y < image.height(); ++y) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(image.row(y).data()));
  }
  png_write_end(png, nullptr);
  return bytes;
}

template <class Sample>
void write(const std::filesystem::path& path, const Image<Sample>& image, PngEffort effort) {
  if (image.empty()) throw ImageError(path.string() + ": there is no image to write");
  try {
    writeFileAtomically(path, encode(image, effort));
  } catch (const std::system_error& error) {
    throw ImageError(error.what());  // names the file already
  } catch (const std::runtime_error& error) {
    throw ImageError(path.string() + ": " + error.what());
  }
}

}  // namespace

void checkPromisedSize(std::int64_t width, std::int64_t height, std::uintmax_t pixelsInFile) {
  if (width > kMaxImageExtent || height > kMaxImageExtent) {
    throw std::runtime_error("larger than 32768 pixels on a side");
  }
  if (width * height > kMaxImageArea) throw std::runtime_error("more than 2^28 pixels");
  if (static_cast<std::uintmax_t>(width * height) > pixelsInFile) {
    throw std::runtime_error("truncated: the header promises more pixels than the file can hold");
  }
}

Image8 readPng8(const std::filesystem::path& path) {
  return read<std::uint8_t>(path);
}
Image16 readPng16(const std::filesystem::path& path) {
  return read<std::uint16_t>(path);
}
void writePng(const std::filesystem::path& path, const Image8& image, PngEffort effort) {
  write(path, image, effort);
}
void writePng(const std::filesystem::path& path, const Image16& image, PngEffort effort) {
  write(path, image, effort);
}

}  // namespace pixelflex::devices
