#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/camera_response.h"
#include "calib/estimate/exposure_merge.h"
#include "calib/procedure/frame_patch.h"

namespace pixelflex::calib {

/// The light of the middle of one projector's frame while it shows patterns: photographed at exposures chosen one by
/// one where the camera lets itself be told, else from all photographs that there are. Keeps references.
class PatchPhotographer {
 public:
  PatchPhotographer(Photographs& source, std::string projector, const FramePatch& patch, devices::Size picture,
                    const CameraResponse& camera);

  /// Of one second, or of the one exposure that no photograph tells. Patterns come from bright to dark: each is exposed
  /// by what the one before it gave. Throws CaptureError naming the photograph.
  [[nodiscard]] PatchLight light(const ProjectedPattern& pattern);
  /// The same, and the linear light of the whole picture; `region` of it is kept for solving again.
  struct Seen {
    PatchLight patch;
    devices::ImageF picture;
  };
  [[nodiscard]] Seen see(const ProjectedPattern& pattern, const PictureRegion& region);
  /// The same of photographs that only a person can take; not of a camera that is told its exposures.
  [[nodiscard]] PatchLight lightOf(const std::string& name);
  /// The next pattern may be brighter.
  void beginBright() { expected_ = 0; }

 private:
  using Photos = std::vector<ExposedPhoto>;  // whole pictures
  [[nodiscard]] Photos photosOf(const ProjectedPattern& pattern, const PictureRegion& region);
  [[nodiscard]] Photos expose(const ProjectedPattern& pattern, const PictureRegion& region,
                              devices::ExposureRange range);
  [[nodiscard]] Photos taken(const std::string& name);
  [[nodiscard]] PatchLight patchOf(const Photos& photos) const;
  [[nodiscard]] double ladder(double seconds, devices::ExposureRange range);
  [[nodiscard]] ExposedPhoto checked(Photographs::Exposed shot) const;
  void checkTold(const Photographs::Exposed& shot);

  Photographs& source_;
  std::string projector_;
  const FramePatch& patch_;
  devices::Size picture_;
  const CameraResponse& camera_;
  double expected_ = 0;  // light of the brightest channel, of a second; 0: not known
  std::optional<bool> told_;
  std::string first_;  // the photograph that settled it
};

}  // namespace pixelflex::calib
