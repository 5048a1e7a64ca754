#include "devices/image/exposure_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

namespace pixelflex::devices {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// Exif is a TIFF file inside a JPEG: directories of twelve-byte entries, in either byte order.
class Tiff {
 public:
  explicit Tiff(Bytes bytes) : bytes_(bytes), bigEndian_(!bytes.empty() && bytes[0] == 'M') {}

  [[nodiscard]] std::optional<double> exposureTime() const {
    constexpr unsigned kExifDirectory = 0x8769;
    constexpr unsigned kExposureTime = 0x829A;
    constexpr unsigned kShutterSpeed = 0x9201;  // in powers of two
    constexpr double kMostRounding = 1.15;
    const auto first = number(4, 4);
    const auto pointer = first ? entry(*first, kExifDirectory) : std::nullopt;
    const auto directory = pointer ? number(*pointer, 4) : std::nullopt;
    const auto nominal = directory ? rational(*directory, kExposureTime) : std::nullopt;
    const auto speed = directory ? rational(*directory, kShutterSpeed) : std::nullopt;
    if (!nominal || !(*nominal > 0) || !speed) return nominal && *nominal > 0 ? nominal : std::nullopt;
    const double exact = std::exp2(-*speed);
    const double ratio = exact / *nominal;
    return ratio < kMostRounding && ratio > 1 / kMostRounding ? exact : nominal;
  }

 private:
  [[nodiscard]] std::optional<std::size_t> number(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || bytes_.size() - at < length) return std::nullopt;
    std::size_t value = 0;
    for (std::size_t i = 0; i < length; ++i) {
      value = value << 8U | bytes_[at + (bigEndian_ ? i : length - 1 - i)];
    }
    return value;
  }

  /// Where the value of a tag stands, or is pointed to.
  [[nodiscard]] std::optional<std::size_t> entry(std::size_t directory, unsigned tag) const {
    const auto count = number(directory, 2);
    for (std::size_t i = 0; count && i < *count; ++i) {
      const std::size_t at = directory + 2 + 12 * i;
      const auto found = number(at, 2);
      if (!found) return std::nullopt;
      if (*found == tag) return at + 8;
    }
    return std::nullopt;
  }

  /// Signed as a shutter speed is: no exposure time needs the highest bit.
  [[nodiscard]] std::optional<double> rational(std::size_t directory, unsigned tag) const {
    const auto value = entry(directory, tag);
    const auto place = value ? number(*value, 4) : std::nullopt;
    const auto above = place ? number(*place, 4) : std::nullopt;
    const auto below = place ? number(*place + 4, 4) : std::nullopt;
    if (!above || !below || *below == 0) return std::nullopt;
    return static_cast<double>(signedOf(*above)) / static_cast<double>(signedOf(*below));
  }

  static std::int32_t signedOf(std::size_t bits) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits)); }

  Bytes bytes_;
  bool bigEndian_;
};

/// The segments of a JPEG before its picture; the one with Exif, without its title.
std::optional<Bytes> exifOf(Bytes file) {
  constexpr std::string_view kTitle("Exif\0\0", 6);
  if (file.size() < 4 || file[0] != 0xFF || file[1] != 0xD8) return std::nullopt;
  for (std::size_t at = 2; at + 4 <= file.size() && file[at] == 0xFF && file[at + 1] != 0xDA;) {
    const std::size_t length = std::size_t{file[at + 2]} << 8U | file[at + 3];
    if (length < 2 || file.size() - at - 2 < length) return std::nullopt;
    const Bytes body = file.subspan(at + 4, length - 2);
    const bool titled = body.size() > kTitle.size() && std::equal(kTitle.begin(), kTitle.end(), body.begin());
    if (file[at + 1] == 0xE1 && titled) return body.subspan(kTitle.size());
    at += 2 + length;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> exposureTime(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = 1 << 18;  // Exif comes first and is shorter than 64 KiB
  std::ifstream stream(path, std::ios::binary);
  std::vector<std::uint8_t> start(kMostBytes);
  stream.read(reinterpret_cast<char*>(start.data()), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  const auto exif = exifOf(start);
  return exif ? Tiff(*exif).exposureTime() : std::nullopt;
}

}  // namespace pixelflex::devices
