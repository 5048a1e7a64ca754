#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calib/simulate/rig.h"

namespace pixelflex::calib {

/// Largest errors that a kind of rig may have, projector pixels.
struct AccuracyTarget {
  double seamRms = 0, seamMaximum = 0, absoluteRms = 0;
};

/// A kind of rig of the table; every seed gives another of the kind.
struct AccuracyRig {
  std::string name;
  std::function<Rig(std::uint32_t seed)> make;
  AccuracyTarget target;
  std::optional<std::size_t> unit;  // the projector in whose pixels errors count; none: each in its own
  bool dense = false;               // measured with the dense method instead of blobs
};

[[nodiscard]] const std::vector<AccuracyRig>& accuracyRigs();

}  // namespace pixelflex::calib
