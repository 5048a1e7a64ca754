#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/collineation.h"
#include "calib/patterns/method.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// What the camera saw of one projector from one of its places.
struct PlaceView {
  std::size_t place = 0;
  std::vector<PointPair> points;  // projector pixel to undistorted camera pixel
  double cameraScale = 0;         // camera pixels per projector pixel
};

struct SeenProjector {
  const ProjectorConfig* config = nullptr;
  std::vector<PlaceView> views;  // one at least
  int shown = 0;                 // points that the patterns hold
};

/// Report 5.1.3: photographs the patterns on every projector from every place of the camera and finds their points.
class ProjectorStep {
 public:
  /// A projector that cannot be measured is handed to `fail` (which may throw) and left out.
  using Failure = std::function<void(const std::string& projector, const std::string& problem)>;
  ProjectorStep(const CameraIntrinsics& camera, Method method, Photographs& source, Progress& progress, Failure fail)
      : camera_(camera), method_(method), source_(source), progress_(progress), fail_(std::move(fail)) {}

  /// Of these projectors. Throws ProcedureError, CaptureError.
  [[nodiscard]] std::vector<SeenProjector> observe(const std::vector<const ProjectorConfig*>& projectors);

 private:
  struct Decoded;
  struct Pending;
  /// In the order of patternsOf(). Black and white come first and tell how large blobs should be.
  [[nodiscard]] std::vector<devices::Image8> photograph(const ProjectorConfig& config, BlobSize& size);
  void decodePlace(std::size_t place, const std::vector<const ProjectorConfig*>& projectors,
                   std::vector<Pending>& pending);
  /// Why the points may not be used; empty when they may. Warns of what does not keep them from use.
  [[nodiscard]] std::string problemWith(const ProjectorConfig& config, const Decoded& decoded, std::size_t place);
  [[nodiscard]] SeenProjector collect(const ProjectorConfig& config, const std::vector<Pending*>& fromPlaces);

  const CameraIntrinsics& camera_;
  Method method_;
  Photographs& source_;
  Progress& progress_;
  Failure fail_;
  int done_ = 0;
  int total_ = 0;
};

}  // namespace pixelflex::calib
