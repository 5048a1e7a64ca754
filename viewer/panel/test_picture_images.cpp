#include "viewer/panel/test_picture_images.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "viewer/renderer/text_panel.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;
using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kWhite = {255, 255, 255};
constexpr int kPitch = 64;

void paint(Image8& image, int x, int y, const Colour& colour) {
  for (int channel = 0; channel < 3; ++channel) image.at(x, y, channel) = colour.at(static_cast<std::size_t>(channel));
}

Image8 filled(Size size, const Colour& colour) {
  Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) paint(image, x, y, colour);
  }
  return image;
}

bool isNear(int a, int b) {
  return a - b <= 1 && b - a <= 1;
}

/// Lines from the middle outwards, so that neighbours of one size look alike.
Image8 grid(Size size) {
  constexpr Colour kGrey = {150, 150, 150};
  Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool border = x < 2 || y < 2 || x >= size.width - 2 || y >= size.height - 2;
      const bool cross = isNear(x, size.width / 2) || isNear(y, size.height / 2);
      const std::int64_t slope = std::int64_t{x} * size.height;
      const std::int64_t rise = std::int64_t{y} * size.width;
      const std::int64_t fall = std::int64_t{size.height - 1 - y} * size.width;
      const bool diagonal =
          std::min(std::abs(slope - rise), std::abs(slope - fall)) < std::max(size.width, size.height);
      const bool line = (x - size.width / 2) % kPitch == 0 || (y - size.height / 2) % kPitch == 0;
      if (border || cross) {
        paint(image, x, y, kWhite);
      } else if (line || diagonal) {
        paint(image, x, y, kGrey);
      }
    }
  }
  return image;
}

/// The letters alone, white: what is behind stays.
void write(Image8& image, const std::string& text, int scale, int left, int top) {
  const std::vector<std::string> lines = {text};
  const Image8 letters = textPanel(lines, scale);
  for (int y = 0; y < letters.height(); ++y) {
    for (int x = 0; x < letters.width(); ++x) {
      const bool inside = left + x >= 0 && top + y >= 0 && left + x < image.width() && top + y < image.height();
      if (inside && letters.at(x, y) == 255) paint(image, left + x, top + y, kWhite);
    }
  }
}

void writeCentred(Image8& image, const std::string& text, int scale, int middle) {
  const std::vector<std::string> lines = {text};
  const Size size = textPanel(lines, scale).size();
  write(image, text, scale, (image.width() - size.width) / 2, middle - size.height / 2);
}

Image8 nameOf(const std::string& projector, Size size) {
  Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      constexpr int kFrame = 8;
      const bool frame = x < kFrame || y < kFrame || x >= size.width - kFrame || y >= size.height - kFrame;
      paint(image, x, y, frame ? kWhite : Colour{20, 60, 120});
    }
  }
  const std::vector<std::string> lines = {projector};
  const Size one = textPanel(lines, 1).size();
  const int scale = std::max(1, std::min(size.width * 4 / 5 / one.width, size.height * 2 / 3 / one.height));
  writeCentred(image, projector, scale, size.height / 2);
  return image;
}

/// From the finest letters to large ones, at the left, in the middle and at the right.
Image8 focus(Size size) {
  Image8 image = grid(size);
  const std::string text = "sharp to the corners: 0123456789 aegmsw";
  for (int y = 0; y < size.height; y += 2 * kPitch) {
    for (const int scale : {1, 2, 3, 4}) {
      const int left = scale % 2 == 1 ? 16 : size.width / 2 + 16;
      write(image, text, scale, left, y + 8 + (scale / 3) * 40);
    }
  }
  return image;
}

}  // namespace

Image8 drawTestPicture(std::string_view picture, const std::string& projector, Size resolution) {
  if (picture == "off") return Image8(resolution, 3);
  if (picture == "white") return filled(resolution, kWhite);
  if (picture == "red") return filled(resolution, {255, 0, 0});
  if (picture == "green") return filled(resolution, {0, 255, 0});
  if (picture == "blue") return filled(resolution, {0, 0, 255});
  if (picture == "grid") return grid(resolution);
  if (picture == "focus") return focus(resolution);
  if (picture == "name") return nameOf(projector, resolution);
  std::string list;
  for (const auto& each : kTestPictures) list += (list.empty() ? "" : ", ") + std::string(each.name);
  throw std::invalid_argument("\"" + std::string(picture) + "\" is no test picture; there are " + list);
}

}  // namespace pixelflex::viewer
