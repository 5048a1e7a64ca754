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

void LostPicture::setCursor(devices::Image8 image, glm::ivec2 hotspot) {
  cursor_ = std::move(image);
  hotspot_ = hotspot;
  if (!signShown_) renderer_.setCursor(cursor_, hotspot_);
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
  renderer_.setCursor(cursor_, hotspot_);
  renderer_.moveCursor(position_);
}

}  // namespace pixelflex::viewer
