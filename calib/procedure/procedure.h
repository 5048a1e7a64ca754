#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/patterns/method.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/progress.h"
#include "calib/procedure/projector_step.h"
#include "calib/procedure/response_step.h"
#include "calib/store/store.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The steps of `pixelflex calibrate`, in order.
[[nodiscard]] const std::vector<std::string>& stepNames();

struct ProcedureOptions {
  std::vector<std::string> steps;  // none: all that are stale
  bool force = false;              // with no steps: all, stale or not
  std::set<std::string> skip;      // projectors to leave out
  std::set<std::string> only;      // measure these again against the stored rest; steps and force do not apply
  std::optional<Method> method;    // what the projectors show; none: as before, else blobs
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
  std::vector<std::string> runOnly();
  [[nodiscard]] Method chooseMethod() const;

  [[nodiscard]] std::string fingerprint(const std::string& step) const;
  [[nodiscard]] std::string measureStamp(const std::string& kind) const;
  [[nodiscard]] bool canBeRead(const std::optional<std::string>& picture) const;
  [[nodiscard]] bool keepsItsPictures(const std::string& step) const;
  [[nodiscard]] bool stale(const std::string& step) const;
  [[nodiscard]] Photographs& photographs(const std::string& step) const;
  /// What earlier steps measured; throw ProcedureError when they have not run.
  [[nodiscard]] const CameraIntrinsics& knownCamera() const;
  [[nodiscard]] std::vector<SurfaceFit> knownSurfaces() const;
  [[nodiscard]] const Display& knownDisplay() const;
  void requireEarlier(const std::string& step) const;

  std::string runCamera();
  std::string runSurface();
  std::string runProjectors();
  std::string runMesh();
  /// The display stays as it is when it is still lit, so that the desktop keeps its size.
  std::string keepOrFindDisplay();
  std::string runBlend();
  std::string runGamma();
  std::string matchProjectors();
  [[nodiscard]] bool measuresResponses() const;
  /// Repairs leave the responses that the camera measured of the other projectors as they are.
  [[nodiscard]] bool keepsResponse(const std::string& projector) const;
  [[nodiscard]] CameraResponse knownCameraResponse() const;
  /// Of the projectors measured in this run.
  std::map<std::string, MeasuredResponse> responsesByCamera();

  [[nodiscard]] std::vector<const ProjectorConfig*> wantedProjectors() const;
  [[nodiscard]] std::vector<SurfaceFit> surfacesFor(const std::vector<SeenProjector>& seen);
  void keepLight(const ProjectorCalibration& known);
  void addProjector(const SeenProjector& seen, const std::vector<SurfaceFit>& surfaces);
  void reportFailure(const std::string& name, const std::string& problem);

  std::filesystem::path folder_;
  const Wall& wall_;
  Calibration calibration_;
  Photographs* photographs_;
  Progress& progress_;
  Nudges nudges_;
  ProcedureOptions options_;
  Method method_ = Method::kBlobs;
  bool tookPhotographs_ = false;
  bool tookResponses_ = false;
  std::optional<CameraResponse> camera_;           // where it was measured in this run
  std::map<std::string, devices::Image16> masks_;  // by path relative to the folder
  std::map<std::string, std::string> responses_;   // likewise
};

}  // namespace pixelflex::calib
