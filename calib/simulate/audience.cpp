#include "calib/simulate/audience.h"

#include <algorithm>
#include <cmath>

#include "calib/simulate/parallel.h"
#include "calib/simulate/room_raster.h"

namespace pixelflex::calib {

namespace {

using devices::Image8;
using devices::ImageF;

constexpr int kLatticeStep = 4;
constexpr std::size_t kCurveSteps = 16384;

/// sRGB codes of kCurveSteps + 1 levels of light.
const std::vector<std::uint8_t>& srgbCurve() {
  static const std::vector<std::uint8_t> curve = [] {
    std::vector<std::uint8_t> codes(kCurveSteps + 1);
    for (std::size_t i = 0; i <= kCurveSteps; ++i) {
      const double light = static_cast<double>(i) / static_cast<double>(kCurveSteps);
      const double code = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      codes[i] = static_cast<std::uint8_t>(std::lround(255 * code));
    }
    return codes;
  }();
  return curve;
}

void addProjector(ImageF& radiance, const LightMap& map, const LightImage& image) {
  if (map.box().empty()) return;
  const ImageF light = map.render(image);
  for (int y = 0; y < light.height(); ++y) {
    const auto from = light.row(y);
    const auto to = radiance.row(y + map.box().y0).subspan(3 * static_cast<std::size_t>(map.box().x0));
    for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
  }
}

Image8 develop(const ImageF& radiance, const RoomRaster& room, double ambient, double white) {
  Image8 picture(radiance.size(), 3);
  const auto& curve = srgbCurve();
  const auto scale = static_cast<float>(1 / white);
  inTwoHalves(picture.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto light = radiance.row(y);
      const auto out = picture.row(y);
      for (std::size_t i = 0; i < out.size(); ++i) {
        const float total =
            light[i] * room.reflectance.row(y)[i / 3] + static_cast<float>(ambient) * room.ambient.row(y)[i / 3];
        const float level = std::clamp(total * scale, 0.0F, 1.0F);
        out[i] = curve[static_cast<std::size_t>(std::floor(level * static_cast<float>(kCurveSteps) + 0.5F))];
      }
    }
  });
  return picture;
}

}  // namespace

AudienceLight::AudienceLight(const Stage& stage, glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size)
    : stage_(stage), topLeft_(topLeft), bottomRight_(bottomRight), size_(size) {
  const AudienceView view(topLeft, bottomRight, size);
  for (const auto& light : stage.lights()) maps_.emplace_back(view, light, stage.unit(), kLatticeStep);
}

bool AudienceLight::looksAt(glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size) const {
  return topLeft == topLeft_ && bottomRight == bottomRight_ && size == size_;
}

ImageF AudienceLight::of(const std::vector<Image8>& frames) const {
  ImageF radiance(size_, 3);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const auto& spec = stage_.lights()[i].spec();
    const bool black = i >= frames.size() || frames[i].empty();
    const Image8 frame = black ? Image8(spec.resolution, 1) : frames[i];
    addProjector(radiance, maps_[i], LightImage(spec, frame, LightImage::Leak::kWith));
  }
  return radiance;
}

Image8 developAudience(const Stage& stage, const ImageF& light, glm::dvec2 topLeft, glm::dvec2 bottomRight,
                       double white) {
  const AudienceView view(topLeft, bottomRight, light.size());
  const double ambient = stage.rig().room.dark * stage.typicalWhite();
  return develop(light, lookAtRoom(stage.rig(), view), ambient, white > 0 ? white : stage.brightestWhite());
}

}  // namespace pixelflex::calib
