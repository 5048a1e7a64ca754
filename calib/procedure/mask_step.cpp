#include "calib/procedure/mask_step.h"

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/mask.h"
#include "calib/photometric/stacks.h"
#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {
namespace {

/// Projectors that make one picture together.
struct Picture {
  std::vector<std::size_t> projectors;
  std::vector<ProjectorMapping> mappings;
  std::vector<double> densities;

  void add(std::size_t index, const ProjectorMapping& mapping) {
    projectors.push_back(index);
    mappings.push_back(mapping);
    densities.push_back(mapping.meanDensity());
  }
};

/// One, or one for each eye: of a pair, the projector named first in wall.yaml is the left eye's.
std::vector<Picture> picturesOf(StackRule stack, const std::vector<ProjectorCalibration>& projectors) {
  std::vector<ProjectorMapping> mappings(projectors.begin(), projectors.end());
  if (stack == StackRule::kShare) {
    std::vector<Picture> whole(1);
    for (std::size_t i = 0; i < mappings.size(); ++i) whole.front().add(i, mappings[i]);
    return whole;
  }
  const auto partners = stackPartners(mappings);
  std::vector<Picture> eyes(2);
  for (std::size_t i = 0; i < mappings.size(); ++i) {
    if (!partners[i]) {
      throw ProcedureError("stack: left-right needs projectors in pairs, each lighting the same part of the wall; " +
                           projectors[i].name + " has no partner: aim one at it, or choose stack: share");
    }
    eyes[i < *partners[i] ? 0 : 1].add(i, mappings[i]);
  }
  return eyes;
}

}  // namespace

std::vector<devices::Image16> paintMasks(const Blend& blend, const std::vector<ProjectorCalibration>& projectors,
                                         Progress& progress) {
  const MaskRules rules{blend.densityExponent, blend.priorityFeather};
  std::vector<devices::Image16> masks(projectors.size());
  int done = 0;
  for (const auto& picture : picturesOf(blend.stack, projectors)) {
    for (std::size_t k = 0; k < picture.projectors.size(); ++k) {
      masks[picture.projectors[k]] = alphaMask(k, picture.mappings, picture.densities, rules);
      const auto& name = projectors[picture.projectors[k]].name;
      progress.advance(++done, static_cast<int>(projectors.size()), name);
    }
  }
  return masks;
}

}  // namespace pixelflex::calib
