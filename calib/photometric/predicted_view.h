#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/gamut.h"
#include "calib/photometric/response_curve.h"
#include "calib/photometric/wall_raster.h"
#include "calib/store/wall.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What is known of one projector's light, and what is done to it.
struct StoredLight {
  devices::ImageF white;  // a camera's three channels of white above black, stretched over the frame; the unit is
                          // common to all projectors, nothing is zero
  std::optional<Matrix3> primaries;       // columns: what full red, green and blue add to the mean white; none: one
                                          // channel of the camera sees one of the projector
  std::optional<double> leak;             // black over white above black; none: not known, counted as 0
  std::optional<ResponseCurve> response;  // none: sRGB
  devices::Image16 share;                 // blend mask, 65535 = 1
  Matrix3 colour{1, 0, 0, 0, 1, 0, 0, 0, 1};
  devices::Image16 gain;                // stretched over the frame, 65535 = 1; empty: 1
  devices::Image16 lift;                // 65535 = 1; empty: 0
  std::array<double, 3> largestLift{};  // the light of 1
};

/// How much of the correction the projectors show.
enum class Correction {
  kNone,    // the desktop's codes as they are, each projector bright over all of its frame
  kShares,  // responses made straight and the masks
  kWhole,   // colour, gain and black as well
};

/// A place of one projector's frame.
struct FramePlace {
  glm::dvec3 white{0};  // camera channels, above black
  double share = 1;
  double gain = 1;
  glm::dvec3 lift{0};
};

/// The light that one projector makes, in the camera's channels: V (leak + P h), where V is its white at the place, P
/// its primaries relative to its white and h its own linear light. Corrected, h is share * gain * (colour l) + lift of
/// the desktop's light l; not corrected, it is the response to the desktop's codes.
class PredictedProjector {
 public:
  PredictedProjector(StoredLight light, Transfer transfer);

  /// `inFrame`: 0..1 both ways; beyond, as on the border.
  [[nodiscard]] FramePlace placeAt(glm::dvec2 inFrame) const;
  [[nodiscard]] glm::dvec3 lightOf(const FramePlace& place, const std::array<std::uint8_t, 3>& codes,
                                   Correction correction) const;
  [[nodiscard]] const StoredLight& stored() const { return light_; }

 private:
  [[nodiscard]] glm::dvec3 ownLight(const FramePlace& place, const std::array<std::uint8_t, 3>& codes,
                                    Correction correction) const;

  StoredLight light_;
  double leak_;
  std::array<double, 256> desktopLight_{};  // of codes
  Matrix3 relative_{};                      // primaries over white
};

/// What the audience sees of a wall: the sum of all projectors' light over a raster, from measurements instead of a
/// photograph. Sharpness is not part of it.
class PredictedView {
 public:
  /// One mapping a projector, in the same order. The projectors must outlive this.
  PredictedView(std::span<const PredictedProjector> projectors, std::span<const ProjectorMapping> mappings,
                const WallRaster& raster);

  /// `desktop`: three channels, of the raster's size. `offsets`: by how many of its pixels each projector's picture is
  /// off; none: all right. Three channels of linear light, in the unit of the projectors' white.
  [[nodiscard]] devices::ImageF see(const devices::Image8& desktop, Correction correction,
                                    std::span<const glm::dvec2> offsets = {}) const;
  /// The same of one colour all over.
  [[nodiscard]] devices::ImageF seeField(const std::array<std::uint8_t, 3>& codes, Correction correction) const;

  [[nodiscard]] const WallRaster& raster() const { return raster_; }

 private:
  /// Where one projector lights a pixel of the raster.
  struct Spot {
    std::size_t pixel = 0;
    double coverage = 1;  // of the pixel: less than one on the frame's border
    FramePlace place;
  };
  void addSpots(std::size_t projector, const ProjectorMapping& mapping);
  void addLight(std::size_t projector, const Spot& spot, const std::array<std::uint8_t, 3>& codes,
                Correction correction, devices::ImageF& view) const;

  std::span<const PredictedProjector> projectors_;
  WallRaster raster_;
  std::vector<std::vector<Spot>> spots_;  // by projector
};

/// Luminance by the camera's channels (kCameraLuminance), of a colour and of a view.
[[nodiscard]] double luminanceOf(glm::dvec3 light);
[[nodiscard]] devices::ImageF luminanceOf(const devices::ImageF& view);

/// sRGB's light of a code (IEC 61966-2-1).
[[nodiscard]] double lightOfSrgb(std::uint8_t code);

}  // namespace pixelflex::calib
