#pragma once

#include <span>
#include <vector>

namespace pixelflex::calib {

/// Replaces values by the closest never-falling ones in the least-squares sense (pool adjacent violators). Empty
/// weights count every value alike; otherwise one positive weight a value.
void levelFalls(std::span<double> values, std::span<const double> weights = {});

/// The values at `wanted` of the smooth curve through (at[i], values[i]) that has no extremum between two neighbours
/// (PCHIP, Fritsch and Carlson 1980): it never falls where the values never fall. `at` rises strictly and has two
/// entries or more; beyond its ends the curve is constant.
[[nodiscard]] std::vector<double> interpolateMonotone(std::span<const double> at, std::span<const double> values,
                                                      std::span<const double> wanted);

}  // namespace pixelflex::calib
