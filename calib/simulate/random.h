#pragma once

#include <cstdint>

namespace pixelflex::calib {

/// A small seeded generator (splitmix64) whose numbers are the same with every compiler and library, unlike the
/// standard distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

  /// Uniform in [low, high).
  double between(double low, double high) {
    constexpr double kScale = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * (static_cast<double>(next() >> 11U) * kScale);
  }

  /// Mean 0, deviation 1.
  double normal();

 private:
  std::uint64_t state_;
};

}  // namespace pixelflex::calib
