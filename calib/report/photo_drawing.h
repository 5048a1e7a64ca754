#pragma once

#include <filesystem>
#include <string>

#include "calib/store/calibration.h"

namespace pixelflex::calib {

/// The part of a photograph under folder/captures that shows a projector, with a ring about every blob that was found
/// and a cross where one is missing (dots for the many points of a dense measurement). Of several camera places the one
/// that sees it largest. Empty where no photograph is there or can be read: a report on what there is.
[[nodiscard]] std::string drawPhotograph(const std::filesystem::path& folder, const Calibration& calibration,
                                         const ProjectorCalibration& projector);

}  // namespace pixelflex::calib
