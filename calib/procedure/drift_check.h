#pragma once

#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/patterns/drift.h"
#include "calib/procedure/progress.h"
#include "calib/store/calibration.h"

namespace pixelflex::calib {

struct ProjectorDrift {
  std::string name;
  Drift drift;
  std::string verdict;  // for people
};

/// Nothing of the projector's picture was found where the camera should see it, or it is not in the camera's picture.
[[nodiscard]] bool isUnseen(const Drift& drift);
/// So far from its place that its figures say little.
[[nodiscard]] bool isFarOff(const Drift& drift);

/// One photograph of all blobs per calibrated projector, compared with the stored calibration, which is not changed
/// (corrections by hand are left out of it). `only`: these projectors; empty means all. Throws ProcedureError.
[[nodiscard]] std::vector<ProjectorDrift> checkDrift(const Calibration& calibration, Photographs& photographs,
                                                     const std::vector<std::string>& only, Progress& progress);

}  // namespace pixelflex::calib
