#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/estimate/collineation.h"
#include "calib/patterns/blob_decoder.h"
#include "calib/procedure/progress.h"
#include "calib/store/store.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// A step cannot be done; what() says which, why and what to do.
class ProcedureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The steps of `pixelflex calibrate`, in order.
[[nodiscard]] const std::vector<std::string>& stepNames();

struct ProcedureOptions {
  std::vector<std::string> steps;  // none: all that are stale
  bool force = false;              // with no steps: all, stale or not
  std::set<std::string> skip;      // projectors to leave out
  std::set<std::string> only;      // measure these again against the stored rest; steps and force do not apply
  bool goOnWithoutFailed = false;  // a projector that is not found is left out with a warning instead of an error
};

/// Report section 5 from beginning to end. Everything is computed first; nothing in the wall's folder changes until
/// save(). Thread-bound.
class Procedure {
 public:
  /// `photographs` may be null when no step needs any. All references must outlive this.
  Procedure(std::filesystem::path folder, const Wall& wall, Calibration previous, Photographs* photographs,
            Progress& progress);

  /// Runs the steps asked for and returns the names of those that ran. Throws ProcedureError, CaptureError,
  /// StoreError, ResponseError.
  std::vector<std::string> run(const ProcedureOptions& options);

  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  [[nodiscard]] const std::map<std::string, devices::Image16>& masks() const { return masks_; }

  /// Masks and responses first, calibration.yaml last, each atomically; then the photographs used.
  void save();

 private:
  struct Step;
  static const std::vector<Step>& steps();
  std::vector<std::string> runOnly(const ProcedureOptions& options);

  [[nodiscard]] std::string fingerprint(const std::string& step) const;
  [[nodiscard]] std::string measureStamp(const std::string& kind) const;
  [[nodiscard]] bool stale(const std::string& step) const;
  [[nodiscard]] Photographs& photographs(const std::string& step) const;
  /// What earlier steps measured; throw ProcedureError when they have not run.
  [[nodiscard]] const CameraIntrinsics& knownCamera() const;
  [[nodiscard]] const SurfaceFit& knownSurface() const;
  [[nodiscard]] const Display& knownDisplay() const;
  void requireEarlier(const std::string& step) const;

  std::string runCamera(const ProcedureOptions& options);
  std::string runSurface(const ProcedureOptions& options);
  std::string runProjectors(const ProcedureOptions& options);
  /// The display stays as it is when it is still lit, so that the desktop keeps its size.
  std::string keepOrFindDisplay(const ProcedureOptions& options);
  std::string runMesh(const ProcedureOptions& options);
  std::string runBlend(const ProcedureOptions& options);
  std::string runGamma(const ProcedureOptions& options);

  struct FiducialSearch {
    std::vector<PointPair> pairs;  // undistorted camera to wall
    std::string missing;           // marker ids, for messages
    std::string photo;
  };
  FiducialSearch findFiducials(const CameraMapping& camera);
  void addProjector(const ProjectorConfig& config, const DecodedBlobs& decoded, const ProcedureOptions& options);
  void reportFailure(const std::string& name, const std::string& problem, const ProcedureOptions& options);

  std::filesystem::path folder_;
  const Wall& wall_;
  Calibration calibration_;
  Photographs* photographs_;
  Progress& progress_;
  Nudges nudges_;
  bool tookPhotographs_ = false;
  std::map<std::string, devices::Image16> masks_;  // by path relative to the folder
  std::map<std::string, std::string> responses_;   // likewise
};

}  // namespace pixelflex::calib
