#include "calib/procedure/surface_step.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calib/estimate/bent_screen.h"
#include "calib/estimate/fiducial_check.h"
#include "calib/estimate/fiducials.h"
#include "calib/procedure/procedure_error.h"
#include "calib/procedure/screen_check.h"
#include "calib/procedure/wording.h"

namespace pixelflex::calib {
namespace {

std::map<int, glm::dvec2> findInPhoto(const Wall& wall, const CameraIntrinsics& camera, Photographs* source,
                                      std::string& name) {
  std::set<int> wanted;
  for (const auto& fiducial : wall.surface.fiducials) {
    if (fiducial.aruco) wanted.insert(*fiducial.aruco);
  }
  if (wanted.empty()) return {};
  if (source == nullptr) throw ProcedureError("step surface needs photographs: give --photos DIR");
  const auto shot = source->fiducials();
  name = shot.name;
  if (shot.photo.size() != camera.size) {
    throw ProcedureError(shot.name + ": " + sizeText(shot.photo.size()) + " pixels, but the camera was calibrated at " +
                         sizeText(camera.size));
  }
  try {
    return findMarkers(shot.photo, CameraMapping(camera), wanted);
  } catch (const EstimateError& error) {
    throw ProcedureError(shot.name + ": " + error.what());
  }
}

void requireEnough(const Surface& surface, const SeenFiducials& seen) {
  const std::size_t needed = surface.shape == SurfaceShape::kCylinder ? 6 : 4;
  if (seen.pairs.size() >= needed) return;
  throw ProcedureError(seen.photo + ": fewer than " + (needed == 4 ? "four" : "six") +
                       " fiducials: " + std::to_string(seen.pairs.size()) + " of " +
                       std::to_string(surface.fiducials.size()) + " found; markers not found: " + seen.missing +
                       " (are they in the picture, evenly lit, at least 24 pixels wide, with a white border?)");
}

SurfaceFit fitPlane(const Surface& surface, const CameraIntrinsics& camera, const SeenFiducials& seen) {
  if (const auto wrong = explainFiducials(seen.pairs, seen.names, camera)) {
    throw ProcedureError("surface: " + (seen.photo.empty() ? "" : seen.photo + ": ") + *wrong);
  }
  refuseBentFiducials(surface, camera, seen);
  const Homography wallFromCamera = solveCollineation(seen.pairs);
  return {wallFromCamera.rowMajor(), rmsError(wallFromCamera, seen.pairs), {}};
}

}  // namespace

SeenFiducials findFiducials(const Wall& wall, const CameraIntrinsics& camera, Photographs* source, int place) {
  SeenFiducials seen;
  const auto markers = findInPhoto(wall, camera, source, seen.photo);
  const CameraMapping mapping(camera);
  for (const auto& fiducial : wall.surface.fiducials) {
    const std::string name = fiducial.aruco ? std::to_string(*fiducial.aruco) : "by hand";
    if (fiducial.pointInCamera && place == 0) {
      seen.pairs.push_back({mapping.undistortedFromRaw(*fiducial.pointInCamera), fiducial.pointInWall});
      seen.names.push_back(name);
    } else if (const auto found = markers.find(fiducial.aruco.value_or(-1)); found != markers.end()) {
      seen.pairs.push_back({found->second, fiducial.pointInWall});
      seen.names.push_back(name);
    } else {
      seen.missing += (seen.missing.empty() ? "" : ", ") + name;
    }
  }
  return seen;
}

SurfaceFit measureSurface(const Surface& surface, const CameraIntrinsics& camera, const SeenFiducials& seen,
                          Progress& progress) {
  requireEnough(surface, seen);
  if (!seen.missing.empty()) progress.warn(seen.photo + ": markers not found: " + seen.missing);
  try {
    return surface.shape == SurfaceShape::kCylinder ? fitCylinder(seen.pairs, camera, surface.cylinderRadius)
                                                    : fitPlane(surface, camera, seen);
  } catch (const EstimateError& error) {
    throw ProcedureError("surface: " + std::string(error.what()));
  }
}

}  // namespace pixelflex::calib
