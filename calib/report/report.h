#pragma once

#include <filesystem>
#include <string>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// WALL/report.html: one self-contained page with the wall seen from the audience (footprints, display, overlaps), the
/// residuals of every projector magnified, the masks and the figures. `folder` is read for the masks; what is missing
/// there is left out.
[[nodiscard]] std::string reportHtml(const std::filesystem::path& folder, const Wall& wall,
                                     const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
