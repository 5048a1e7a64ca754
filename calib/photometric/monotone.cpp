#include "calib/photometric/monotone.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace pixelflex::calib {
namespace {

struct Pool {
  double mean;
  double weight;
  std::size_t count;
};

Pool joined(const Pool& a, const Pool& b) {
  const double weight = a.weight + b.weight;
  return {(a.mean * a.weight + b.mean * b.weight) / weight, weight, a.count + b.count};
}

/// The slope at an end: a parabola through three points, limited so that the curve keeps its direction.
double endSlope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

std::vector<double> pchipSlopes(std::span<const double> at, std::span<const double> values) {
  const std::size_t n = at.size();
  std::vector<double> h(n - 1);
  std::vector<double> d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = at[i + 1] - at[i];
    d[i] = (values[i + 1] - values[i]) / h[i];
  }
  if (n == 2) return {d[0], d[0]};
  std::vector<double> slopes(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;
    const double left = 2 * h[i] + h[i - 1];
    const double right = h[i] + 2 * h[i - 1];
    slopes[i] = (left + right) / (left / d[i - 1] + right / d[i]);
  }
  slopes.front() = endSlope(h[0], h[1], d[0], d[1]);
  slopes.back() = endSlope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  return slopes;
}

}  // namespace

void levelFalls(std::span<double> values, std::span<const double> weights) {
  assert(weights.empty() || weights.size() == values.size());
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights.empty() ? 1 : weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back() = joined(pools.back(), last);
    }
  }
  std::size_t i = 0;
  for (const Pool& pool : pools) {
    std::ranges::fill(values.subspan(i, pool.count), pool.mean);
    i += pool.count;
  }
}

std::vector<double> interpolateMonotone(std::span<const double> at, std::span<const double> values,
                                        std::span<const double> wanted) {
  assert(at.size() >= 2 && at.size() == values.size());
  const auto slopes = pchipSlopes(at, values);
  std::vector<double> result;
  for (const double x : wanted) {
    const double inside = std::clamp(x, at.front(), at.back());
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(at, inside) - at.begin());
    const std::size_t i = std::min(next, at.size() - 1) - 1;
    const double h = at[i + 1] - at[i];
    const double t = (inside - at[i]) / h;
    const double rise = t * t * (3 - 2 * t);
    result.push_back(values[i] * (1 - rise) + values[i + 1] * rise +
                     h * t * (1 - t) * (slopes[i] * (1 - t) - slopes[i + 1] * t));
  }
  return result;
}

}  // namespace pixelflex::calib
