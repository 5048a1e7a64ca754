#include "calib/procedure/display_step.h"

#include <string>

#include "calib/geometry/display_area.h"
#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {

Display measureDisplay(const Wall& wall, const Calibration& calibration) {
  std::vector<Outline> outlines;
  std::vector<double> densities;
  for (const auto& projector : calibration.projectors) {
    const ProjectorMapping mapping(projector);
    try {
      outlines.push_back(footprint(mapping));
    } catch (const GeometryError& error) {
      throw ProcedureError("projector " + projector.name + ": " + error.what());
    }
    densities.push_back(mapping.meanDensity());
  }
  try {
    return findDisplay(outlines, densities, wall.display, wall.desktop);
  } catch (const GeometryError& error) {
    throw ProcedureError(std::string("mesh: ") + error.what());
  }
}

bool displayIsLit(const Calibration& calibration) {
  if (!calibration.display) return false;
  std::vector<Outline> outlines;
  for (const auto& projector : calibration.projectors) outlines.push_back(footprint(ProjectorMapping(projector)));
  return isLit(*calibration.display, outlines);
}

}  // namespace pixelflex::calib
