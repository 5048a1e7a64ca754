#include "calib/photometric/stacks.h"

namespace pixelflex::calib {
namespace {

constexpr double kSameShare = 0.9;

/// How much of a frame another one lights, 0..1.
double litShare(const ProjectorMapping& own, const ProjectorMapping& other) {
  constexpr int kSteps = 16;
  const devices::Size frame = own.resolution();
  int lit = 0;
  for (int k = 0; k < kSteps * kSteps; ++k) {
    const glm::dvec2 part((k % kSteps + 0.5) / kSteps, (static_cast<int>(k / kSteps) + 0.5) / kSteps);
    const auto inWall = own.wallFromProjector({part.x * frame.width, part.y * frame.height});
    const auto inOther = inWall ? other.projectorFromWall(*inWall) : std::nullopt;
    if (inOther && other.insideFrame(*inOther)) ++lit;
  }
  return double(lit) / (kSteps * kSteps);
}

}  // namespace

std::vector<std::optional<std::size_t>> stackPartners(std::span<const ProjectorMapping> projectors) {
  std::vector<std::optional<std::size_t>> partners(projectors.size());
  std::vector<int> counts(projectors.size(), 0);
  for (std::size_t a = 0; a < projectors.size(); ++a) {
    for (std::size_t b = a + 1; b < projectors.size(); ++b) {
      if (litShare(projectors[a], projectors[b]) < kSameShare) continue;
      if (litShare(projectors[b], projectors[a]) < kSameShare) continue;
      partners[a] = b;
      partners[b] = a;
      ++counts[a];
      ++counts[b];
    }
  }
  for (std::size_t a = 0; a < projectors.size(); ++a) {
    if (counts[a] != 1 || counts[*partners[a]] != 1) partners[a].reset();
  }
  return partners;
}

}  // namespace pixelflex::calib
