#pragma once

#include <filesystem>
#include <string>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

/// WALL/report.html: one self-contained page, no script and no network. A verdict in words with cause and cure for all
/// that is not good; the wall with footprints, names and display; its sharpness; every overlap's expected seam error;
/// every projector's photograph with what was found in it, residuals, density and mask. `folder` is read for captures
/// and masks; what is missing or damaged there is left out.
[[nodiscard]] std::string reportHtml(const std::filesystem::path& folder, const Wall& wall,
                                     const Calibration& calibration, const Summary& summary);

}  // namespace pixelflex::calib
