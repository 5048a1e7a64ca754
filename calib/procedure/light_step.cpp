#include "calib/procedure/light_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/estimate/light_field.h"
#include "calib/photometric/black_lift.h"
#include "calib/photometric/gamut.h"
#include "calib/photometric/lift_colour.h"
#include "calib/photometric/light_error.h"
#include "calib/photometric/luminance_target.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/white_photographs.h"

namespace pixelflex::calib {
namespace {

using devices::Image16;
using devices::ImageF;

constexpr int kNodesAcross = 96;    // of a projector's light field and gain map
constexpr int kRasterAcross = 480;  // of the display
constexpr double kLiftRoom = 1.1;   // of a lift map, over the largest lift at the raster's pixels

WallRaster rasterOf(const Display& display) {
  const double pitch = (display.right - display.left) / kRasterAcross;
  const int rows = std::max(2, static_cast<int>(std::ceil((display.bottom - display.top) / pitch)));
  return {{display.left, display.top}, pitch, {kRasterAcross, rows}};
}

/// Bilinear among the nodes around a place of the frame, which stand in the middles of their cells; 0 where one of them
/// was not seen.
double fieldAt(const ImageF& field, glm::dvec2 inFrame, int channel) {
  const glm::dvec2 p = glm::dvec2(inFrame.x * field.width(), inFrame.y * field.height()) - 0.5;
  const double x = std::clamp(p.x, 0.0, field.width() - 1.001);
  const double y = std::clamp(p.y, 0.0, field.height() - 1.001);
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const double value = field.at(column + k % 2, row + k / 2, channel);
    if (value <= 0) return 0;
    sum += value * (k % 2 == 1 ? x - column : 1 - (x - column)) * (k / 2 == 1 ? y - row : 1 - (y - row));
  }
  return sum;
}

double luminance(const ImageF& field, glm::dvec2 inFrame) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += kCameraLuminance[static_cast<std::size_t>(c)] * fieldAt(field, inFrame, c);
  return sum;
}

/// The columns are what full red, green and blue add to white, in the camera's channels. Where they were not
/// photographed, a camera's channels are taken to see one of the projector's each.
Matrix3 primariesOf(const PhotographedLight& photographed, const ImageF& white) {
  std::array<double, 3> mean{};
  double count = 0;
  for (int y = 0; y < white.height(); ++y) {
    for (int x = 0; x < white.width(); ++x) {
      if (white.at(x, y, 1) <= 0) continue;
      for (int c = 0; c < 3; ++c) mean[static_cast<std::size_t>(c)] += white.at(x, y, c);
      ++count;
    }
  }
  Matrix3 primaries = photographed.primaries.value_or(Matrix3{1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (std::size_t row = 0; row < 3; ++row) {
    const double sum = primaries[3 * row] + primaries[3 * row + 1] + primaries[3 * row + 2];
    for (std::size_t c = 0; c < 3; ++c) primaries[3 * row + c] *= mean[row] / std::max(count, 1.0) / sum;
  }
  return primaries;
}

/// Colour samples of 16 bits; 65535 is `brightest`.
Image16 packed(const ImageF& field, double brightest) {
  Image16 image(field.size(), 3);
  for (std::size_t i = 0; i < image.samples().size(); ++i) {
    image.samples()[i] = static_cast<std::uint16_t>(std::lround(65535 * field.samples()[i] / brightest));
  }
  return image;
}

class LightMatcher {
 public:
  LightMatcher(const Wall& wall, const Calibration& calibration, const std::vector<Image16>& masks,
               const std::vector<PhotographedLight>& photographed)
      : wall_(wall),
        calibration_(calibration),
        masks_(masks),
        raster_(rasterOf(*calibration.display)),
        photographed_(photographed),
        corrected_(withoutVignetting(calibration, photographed)) {
    for (const auto& projector : calibration.projectors) mappings_.emplace_back(projector);
  }

  LightResult match(const std::vector<double>& leak) {
    matchColour();
    fillMaps(leak);
    const double perDegree = kRasterAcross / kDisplayDegrees;
    LightResult result;
    if (wall_.blend.evenBlack) targetBlack(leak, perDegree);
    const LuminanceTarget target = luminanceTarget(besideLift(), wall_.blend.uniformity.value_or(0), perDegree);
    result.kept = target.kept;
    for (std::size_t i = 0; i < mappings_.size(); ++i) addMatch(i, target, result);
    addMeasured(leak, result);
    if (black_) {
      result.contrastNative = black_->contrastNative;
      result.contrastEven = black_->contrastEven;
    }
    return result;
  }

 private:
  void matchColour() {
    for (std::size_t i = 0; i < corrected_.size(); ++i) {
      primaries_.push_back(primariesOf(photographed_[i], corrected_[i]));
    }
    gamut_ = commonGamut(primaries_);
  }

  void fillMaps(const std::vector<double>& leak) {
    for (std::size_t i = 0; i < mappings_.size(); ++i) {
      auto& maps = maps_.emplace_back();
      maps.white = ImageF(raster_.size, 1);
      maps.share = ImageF(raster_.size, 1);
      if (wall_.blend.evenBlack) maps.black = ImageF(raster_.size, 1);
      for (int y = 0; y < raster_.size.height; ++y) {
        for (int x = 0; x < raster_.size.width; ++x) fillPixel(i, x, y, leak[i], maps);
      }
    }
  }

  void fillPixel(std::size_t i, int x, int y, double leak, ProjectorLightMaps& maps) const {
    const auto& mapping = mappings_[i];
    const auto p = mapping.projectorFromWall(raster_.wallFromRaster({x + 0.5, y + 0.5}));
    if (!p || !mapping.insideFrame(*p)) return;
    const devices::Size size = mapping.resolution();
    const double native = luminance(corrected_[i], {p->x / size.width, p->y / size.height});
    maps.white.at(x, y) = static_cast<float>(native * gamut_.projectors[i].kept);
    if (!maps.black.empty()) maps.black.at(x, y) = static_cast<float>(native * leak);
    const int column = std::min(static_cast<int>(p->x), size.width - 1);
    const int row = std::min(static_cast<int>(p->y), size.height - 1);
    maps.share.at(x, y) = static_cast<float>(masks_[i].at(column, row) / 65535.0);
  }

  void targetBlack(const std::vector<double>& leak, double perDegree) {
    for (std::size_t i = 0; i < leak.size(); ++i) {
      if (leak[i] >= 0) continue;
      throw ProcedureError(
          "black: even needs gamma of every projector, readings or camera, which tells how much it leaks; " +
          calibration_.projectors[i].name + " has none");
    }
    const LuminanceTarget first = luminanceTarget(maps_, wall_.blend.uniformity.value_or(0), perDegree);
    // The lift is added after the colours are matched: it is a part of the whole white.
    native_ = maps_;
    for (std::size_t i = 0; i < native_.size(); ++i) {
      for (float& white : native_[i].white.samples()) white /= static_cast<float>(gamut_.projectors[i].kept);
    }
    black_ = blackTarget(native_, first.target, 0);
    liftColours_ = liftColours(primaries_, native_, *black_);
  }

  /// What is left for white, from which the lift takes room.
  [[nodiscard]] std::vector<ProjectorLightMaps> besideLift() const {
    auto maps = maps_;
    const auto room = static_cast<float>(black_ ? 1 - largestLight() : 1);
    for (auto& map : maps) {
      for (float& white : map.white.samples()) white *= room;
    }
    return maps;
  }

  /// That any projector's lift asks of a channel.
  [[nodiscard]] double largestLight() const {
    double strongest = 0;
    for (const auto& colour : liftColours_) strongest = std::max(strongest, std::ranges::max(colour));
    return std::min(0.5, strongest * black_->largestLift);
  }

  void addMatch(std::size_t i, const LuminanceTarget& target, LightResult& result) const {
    const std::string& name = calibration_.projectors[i].name;
    LightMatch match;
    match.colour = gamut_.projectors[i].colour;
    match.gain = "calibration/" + name + "-gain.png";
    result.images[*match.gain] = gainMap(mappings_[i], maps_[i].white, target.target, raster_, corrected_[i].size());
    if (black_) {
      match.black = "calibration/" + name + "-black.png";
      const double largest = kLiftRoom * black_->largestLift;
      for (std::size_t c = 0; c < 3; ++c) match.largestBlack.at(c) = std::min(1.0, largest * liftColours_[i].at(c));
      result.images[*match.black] = blackLiftMap(i, mappings_, native_, *black_, raster_, masks_[i], largest);
    }
    result.matches[name] = match;
  }

  void addMeasured(const std::vector<double>& leak, LightResult& result) const {
    double brightest = 0;
    for (const auto& white : corrected_) {
      for (const float value : white.samples()) brightest = std::max(brightest, double(value));
    }
    for (std::size_t i = 0; i < corrected_.size(); ++i) {
      const std::string& name = calibration_.projectors[i].name;
      MeasuredLight measured{"calibration/" + name + "-white.png", brightest, primaries_[i],
                             photographed_[i].primaries.has_value(), std::nullopt};
      if (leak[i] >= 0) measured.leak = leak[i];
      result.images[measured.white] = packed(corrected_[i], brightest);
      result.measured[name] = measured;
    }
  }

  const Wall& wall_;
  const Calibration& calibration_;
  const std::vector<Image16>& masks_;
  WallRaster raster_;
  std::vector<ProjectorMapping> mappings_;
  const std::vector<PhotographedLight>& photographed_;
  std::vector<ImageF> corrected_;  // white without the camera's vignetting
  std::vector<Matrix3> primaries_;
  CommonGamut gamut_;
  std::vector<ProjectorLightMaps> maps_;    // white as the common gamut leaves it
  std::vector<ProjectorLightMaps> native_;  // white as it is, where black is evened
  std::optional<BlackTarget> black_;
  std::vector<std::array<double, 3>> liftColours_;
};

}  // namespace

LightResult matchLight(const Wall& wall, const Calibration& calibration, Method method,
                       const std::vector<Image16>& masks, const std::vector<double>& leak, const CameraResponse& camera,
                       Photographs& source, Progress& progress) {
  const auto photographed = photographLight(calibration, camera, method, kNodesAcross, source, progress);
  try {
    return LightMatcher(wall, calibration, masks, photographed).match(leak);
  } catch (const LightError& error) {
    throw ProcedureError(std::string("gamma: ") + error.what());
  } catch (const EstimateError& error) {
    throw ProcedureError(std::string("gamma: ") + error.what());
  }
}

}  // namespace pixelflex::calib
