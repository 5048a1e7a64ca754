#pragma once

#include <string>
#include <vector>

#include "calib/procedure/verdicts.h"

namespace pixelflex::calib {

/// The wall's figures at a glance.
[[nodiscard]] std::string factsHtml(const Wall& wall, const Calibration& calibration, const Summary& summary);

/// Each finding with cause and cure; a line that all is well when there are none.
[[nodiscard]] std::string findingsHtml(const std::vector<Finding>& findings);

/// A row a projector.
[[nodiscard]] std::string projectorTable(const Wall& wall, const Summary& summary);

/// A row an overlap; a sentence when there are none.
[[nodiscard]] std::string seamTable(const Summary& summary, const std::vector<Finding>& findings);

/// Camera, surface and what steps have run.
[[nodiscard]] std::string measurementTable(const Wall& wall, const Calibration& calibration);

/// What the report's words mean.
[[nodiscard]] std::string termsHtml();

}  // namespace pixelflex::calib
