#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::devices {

/// A raster of interleaved samples, rows from top to bottom without padding. Pixel (x, y) covers [x, x+1) x [y, y+1);
/// its centre is at (x + 0.5, y + 0.5). Colour images are red, green, blue; a fourth channel is alpha.
template <class Sample>
class Image {
 public:
  Image() = default;

  /// All samples zero. Throws std::invalid_argument unless the extent is positive and there are one to four channels.
  Image(Size size, int channels) : size_(size), channels_(channels) {
    if (size.width <= 0 || size.height <= 0 || channels < 1 || channels > 4) {
      throw std::invalid_argument("image extent must be positive, with one to four channels");
    }
    samples_.resize(static_cast<std::size_t>(size.area()) * static_cast<std::size_t>(channels));
  }

  [[nodiscard]] Size size() const { return size_; }
  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] bool empty() const { return samples_.empty(); }

  [[nodiscard]] std::span<Sample> samples() { return samples_; }
  [[nodiscard]] std::span<const Sample> samples() const { return samples_; }
  [[nodiscard]] std::span<Sample> row(int y) { return samples().subspan(rowBegin(y), rowLength()); }
  [[nodiscard]] std::span<const Sample> row(int y) const { return samples().subspan(rowBegin(y), rowLength()); }

  [[nodiscard]] Sample& at(int x, int y, int channel = 0) { return samples_[index(x, y, channel)]; }
  [[nodiscard]] const Sample& at(int x, int y, int channel = 0) const { return samples_[index(x, y, channel)]; }

  bool operator==(const Image&) const = default;

 private:
  [[nodiscard]] std::size_t rowLength() const {
    return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(channels_);
  }
  [[nodiscard]] std::size_t rowBegin(int y) const {
    assert(y >= 0 && y < size_.height);
    return static_cast<std::size_t>(y) * rowLength();
  }
  [[nodiscard]] std::size_t index(int x, int y, int channel) const {
    assert(x >= 0 && x < size_.width && channel >= 0 && channel < channels_);
    return rowBegin(y) + static_cast<std::size_t>(x) * static_cast<std::size_t>(channels_) +
           static_cast<std::size_t>(channel);
  }

  Size size_;
  int channels_ = 0;
  std::vector<Sample> samples_;
};

using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;
using ImageF = Image<float>;

}  // namespace pixelflex::devices
