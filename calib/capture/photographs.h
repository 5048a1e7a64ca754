#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "calib/patterns/method.h"
#include "calib/patterns/projected_pattern.h"
#include "calib/store/calibration.h"
#include "devices/camera/camera.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// Photographs cannot be had; what() names the file or device and says what to do.
class CaptureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of a picture, pixels, half-open.
struct PictureRegion {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Which of the photographs used are kept: all, or those of the response, beside what is kept of the others.
enum class Kept { kAll, kResponse };

/// The photographs that a calibration works from, asked for one by one. Thread-bound.
class Photographs {
 public:
  Photographs() = default;
  virtual ~Photographs() = default;
  Photographs(const Photographs&) = delete;
  Photographs& operator=(const Photographs&) = delete;

  /// The places that the camera stands at, one after the other; the fiducials and patterns asked for are seen from the
  /// place chosen last (the first, to begin with). The camera and its lens are the same everywhere.
  [[nodiscard]] virtual int placeCount() const { return 1; }
  virtual void choosePlace(int /*place*/) {}

  /// Known intrinsics instead of checkerboard photographs.
  [[nodiscard]] virtual std::optional<CameraIntrinsics> knownCamera() { return std::nullopt; }

  struct Named {
    std::string name;  // for messages
    devices::Image8 photo;
  };
  /// The next photograph of the checkerboard; none after the last.
  [[nodiscard]] virtual std::optional<Named> nextCheckerboard() = 0;
  /// How many of them there will be, for progress; 0 when unknown.
  [[nodiscard]] virtual int checkerboardCount() const = 0;
  /// Where they come from, for the message that there are none.
  [[nodiscard]] virtual std::string checkerboardPlace() const { return "the camera"; }

  /// Whether the wall in room light was photographed from this place; of several places some may see no marker.
  [[nodiscard]] virtual bool hasFiducials() { return true; }
  /// The wall with its markers in room light.
  [[nodiscard]] virtual Named fiducials() = 0;

  /// The method whose patterns were photographed, where that is settled already.
  [[nodiscard]] virtual std::optional<Method> methodTaken() { return std::nullopt; }

  /// The size of blobs in this projector's photographs, where that is settled already.
  [[nodiscard]] virtual std::optional<BlobSize> blobSizeTaken(const std::string& /*projector*/) { return std::nullopt; }

  /// Whether anything was photographed of this projector at all.
  [[nodiscard]] virtual bool hasProjector(const std::string& projector) = 0;
  /// Whether this photograph can be had: for what a calibration can do without.
  [[nodiscard]] virtual bool hasPattern(const std::string& projector, const ProjectedPattern& /*pattern*/) {
    return hasProjector(projector);
  }
  /// One pattern on this projector, every other one black.
  [[nodiscard]] virtual devices::Image8 pattern(const std::string& projector, const ProjectedPattern& pattern) = 0;

  /// Exposures, for the response: either they can be asked for (a range, and exposed()), or photographs are as they
  /// were taken (no range, and exposures()).
  [[nodiscard]] virtual std::optional<devices::ExposureRange> exposureRange() { return std::nullopt; }
  /// Seconds, of photographs for which none is asked for, in the dark; only with a range.
  [[nodiscard]] virtual double usualExposure() { return 1; }

  struct Exposed {
    std::string name;               // for messages
    std::optional<double> seconds;  // where it is told
    devices::Image8 photo;
  };
  /// One pattern on this projector at an exposure of about `seconds`. Only `region` of the picture is kept for solving
  /// again.
  [[nodiscard]] virtual Exposed exposed(const std::string& projector, const ProjectedPattern& pattern, double seconds,
                                        const PictureRegion& region);
  /// Every photograph of a pattern by its name, one or more.
  [[nodiscard]] virtual std::vector<Exposed> exposures(const std::string& projector, const std::string& pattern);
  /// Whether that would find any, seen from here.
  [[nodiscard]] virtual bool hasExposures(const std::string& /*projector*/, const std::string& /*pattern*/) {
    return false;
  }

  /// A short text that changes when the photographs of a kind would: "checkerboard", "fiducials", "patterns" or
  /// "response".
  [[nodiscard]] virtual std::string stamp(const std::string& kind) const = 0;

  /// Called once after success: keeps the photographs used under the wall's captures/.
  virtual void keep(Kept what) = 0;
};

/// Relative path of a pattern's photograph without its ending: "p1/bit3".
[[nodiscard]] std::filesystem::path patternPath(const std::string& projector, const ProjectedPattern& pattern);

/// What one projector must show.
struct ProjectorPatterns {
  std::string name;
  devices::Size resolution;
  std::vector<ProjectedPattern> patterns;
};

/// Writes every picture, and README.txt for the person who photographs them (contract: "Photographs: one rule").
void writePatterns(const std::filesystem::path& folder, const std::vector<ProjectorPatterns>& projectors,
                   Method method = Method::kBlobs);

}  // namespace pixelflex::calib
