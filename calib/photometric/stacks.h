#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calib/geometry/projector_mapping.h"

namespace pixelflex::calib {

/// For each projector the one that lights the same part of the wall (each covers nine tenths of the other's frame),
/// where there is exactly one.
[[nodiscard]] std::vector<std::optional<std::size_t>> stackPartners(std::span<const ProjectorMapping> projectors);

}  // namespace pixelflex::calib
