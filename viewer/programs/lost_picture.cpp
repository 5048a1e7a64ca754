#include "viewer/programs/lost_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pixelflex::viewer {
namespace {

// Of the desktop's light: still to be read, and plainly not as it was.
constexpr float kDimmed = 0.3F;

constexpr std::array<std::uint8_t, 3> kAmber{255, 176, 0};
constexpr std::array<std::uint8_t, 3> kInk{40, 28, 0};

/// Where the mark's stroke and dot are; the disc is that of radius 1 around the origin.
bool inMark(glm::dvec2 p) {
  const bool stroke = std::abs(p.x) < 0.11 && p.y > -0.62 && p.y < 0.22;
  return stroke || std::hypot(p.x, p.y - 0.5) < 0.14;
}

}  // namespace

devices::Image8 lostSign(int extent) {
  devices::Image8 sign({extent, extent}, 4);
  const double radius = extent / 2.0;
  for (int y = 0; y < extent; ++y) {
    for (int x = 0; x < extent; ++x) {
      const glm::dvec2 p{(x + 0.5 - radius) / radius, (y + 0.5 - radius) / radius};
      std::ranges::copy(inMark(p) ? kInk : kAmber, &sign.at(x, y));
      const double inside = std::clamp((1 - std::hypot(p.x, p.y)) * radius, 0.0, 1.0);
      sign.at(x, y, 3) = static_cast<std::uint8_t>(std::lround(255 * inside));
    }
  }
  return sign;
}

devices::Image8 ringAround(const devices::Image8& cursor, glm::ivec2 hotspot, int extent) {
  devices::Image8 image({extent, extent}, 4);
  const double radius = extent / 2.0;
  const double stroke = std::max(radius / 12, 3.0);
  for (int y = 0; y < extent; ++y) {
    for (int x = 0; x < extent; ++x) {
      // Amber between two lines of ink, so that it is seen on anything.
      const double fromRing = std::abs(std::hypot(x + 0.5 - radius, y + 0.5 - radius) - (radius - 2 * stroke));
      std::ranges::copy(fromRing < stroke ? kAmber : kInk, &image.at(x, y));
      image.at(x, y, 3) = fromRing < 1.5 * stroke ? 255 : 0;
    }
  }
  const glm::ivec2 corner = glm::ivec2(extent / 2, extent / 2) - hotspot;
  for (int y = 0; y < cursor.height(); ++y) {
    for (int x = 0; x < cursor.width(); ++x) {
      const glm::ivec2 to = corner + glm::ivec2(x, y);
      const bool fits = to.x >= 0 && to.y >= 0 && to.x < extent && to.y < extent;
      if (fits && cursor.at(x, y, 3) > 0) std::copy_n(&cursor.at(x, y), 4, &image.at(to.x, to.y));
    }
  }
  return image;
}

void LostPicture::setCursor(devices::Image8 image, glm::ivec2 hotspot) {
  cursor_ = std::move(image);
  hotspot_ = hotspot;
  putCursor();
}

void LostPicture::putCursor() {
  if (signShown_) return;
  if (ringExtent_ == 0) return renderer_.setCursor(cursor_, hotspot_);
  renderer_.setCursor(ringAround(cursor_, hotspot_, ringExtent_), {ringExtent_ / 2, ringExtent_ / 2});
}

void LostPicture::ring(devices::Size desktop) {
  ringExtent_ = std::clamp(desktop.height / 4, 96, 1024);
  putCursor();
}

void LostPicture::unring() {
  ringExtent_ = 0;
  putCursor();
}

void LostPicture::moveCursor(glm::ivec2 position) {
  position_ = position;
  if (!signShown_) renderer_.moveCursor(position_);
}

void LostPicture::lose(devices::Size desktop) {
  if (desktop.area() == 0) return;
  if (whenLost_ == WhenLost::kDim) renderer_.setBrightness(kDimmed);
  if (whenLost_ == WhenLost::kMark) putSign(desktop);
}

/// In the upper part of the wall's middle, where it is seen and covers little.
void LostPicture::putSign(devices::Size desktop) {
  const int extent = std::clamp(desktop.height / 10, 32, 512);
  renderer_.setCursor(lostSign(extent), {extent / 2, 0});
  renderer_.moveCursor({desktop.width / 2, desktop.height / 20});
  signShown_ = true;
}

void LostPicture::comeBack() {
  renderer_.setBrightness(1);
  if (!std::exchange(signShown_, false)) return;
  putCursor();
  renderer_.moveCursor(position_);
}

}  // namespace pixelflex::viewer
