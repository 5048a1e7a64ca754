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

/// One photograph of all blobs per calibrated projector, compared with the stored calibration, which is not changed
/// (corrections by hand are left out of it). `only`: these projectors; empty means all. Throws ProcedureError.
[[nodiscard]] std::vector<ProjectorDrift> checkDrift(const Calibration& calibration, Photographs& photographs,
                                                     const std::vector<std::string>& only, Progress& progress);

}  // namespace pixelflex::calib
