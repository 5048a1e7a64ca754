#include "calib/geometry/projector_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "calib/geometry/nudge_map.h"

namespace pixelflex::calib {

ProjectorMapping::ProjectorMapping(const ProjectorModel& model, devices::Size resolution)
    : projectorFromWall_(model.projectorFromWall),
      wallFromNormalised_(projectorFromWall_.inverse()),
      lens_(model.radial, model.tangential),
      centre_(model.centre),
      scale_(model.scale),
      resolution_(resolution),
      largestRadius_(0),
      sign_(1) {
  const double w = resolution.width;
  const double h = resolution.height;
  for (const glm::dvec2 corner : std::array<glm::dvec2, 5>{{{0, 0}, {w, 0}, {w, h}, {0, h}, {w / 2, h / 2}}}) {
    const glm::dvec2 distorted = (corner - centre_) / scale_;
    const glm::dvec2 ideal = lens_.undistort(distorted).value_or(distorted);
    largestRadius_ = std::max(largestRadius_, glm::length(ideal));
  }
  largestRadius_ *= 1.1;
  const glm::dvec2 middle = (glm::dvec2(w / 2, h / 2) - centre_) / scale_;
  const glm::dvec2 middleInWall = wallFromNormalised_.map(lens_.undistort(middle).value_or(middle));
  sign_ = projectorFromWall_.weight(middleInWall) < 0 ? -1 : 1;
}

ProjectorMapping::ProjectorMapping(const ProjectorCalibration& projector)
    : ProjectorMapping(projector.model, projector.resolution) {
  if (!projector.nudge) return;
  nudgedFromMeasured_ = nudgedFromMeasured(*projector.nudge, projector.resolution);
  measuredFromNudged_ = nudgedFromMeasured_.inverse();
}

std::optional<glm::dvec2> ProjectorMapping::wallFromProjector(glm::dvec2 pointInProjector) const {
  return wallFromMeasured(measuredFromNudged_.map(pointInProjector));
}

std::optional<glm::dvec2> ProjectorMapping::wallFromMeasured(glm::dvec2 pointInMeasured) const {
  const auto ideal = lens_.undistort((pointInMeasured - centre_) / scale_);
  if (!ideal) return std::nullopt;
  const glm::dvec2 pointInWall = wallFromNormalised_.map(*ideal);
  if (!std::isfinite(pointInWall.x) || !std::isfinite(pointInWall.y)) return std::nullopt;
  if (projectorFromWall_.weight(pointInWall) * sign_ <= 0) return std::nullopt;
  return pointInWall;
}

std::optional<glm::dvec2> ProjectorMapping::projectorFromWall(glm::dvec2 pointInWall) const {
  if (projectorFromWall_.weight(pointInWall) * sign_ <= 0) return std::nullopt;
  const glm::dvec2 ideal = projectorFromWall_.map(pointInWall);
  if (glm::dot(ideal, ideal) > largestRadius_ * largestRadius_) return std::nullopt;
  return nudgedFromMeasured_.map(lens_.distort(ideal) * scale_ + centre_);
}

Homography ProjectorMapping::flatWallFromProjector() const {
  return wallFromNormalised_ * Homography::scaling(glm::dvec2(1 / scale_)) * Homography::translation(-centre_) *
         measuredFromNudged_;
}

bool ProjectorMapping::insideFrame(glm::dvec2 p) const {
  return p.x >= 0 && p.y >= 0 && p.x <= resolution_.width && p.y <= resolution_.height;
}

double ProjectorMapping::density(glm::dvec2 pointInProjector) const {
  const auto origin = wallFromProjector(pointInProjector);
  const auto right = wallFromProjector(pointInProjector + glm::dvec2(1, 0));
  const auto below = wallFromProjector(pointInProjector + glm::dvec2(0, 1));
  if (!origin || !right || !below) return 0;
  const glm::dvec2 u = *right - *origin;
  const glm::dvec2 v = *below - *origin;
  return 1 / std::sqrt(std::abs(u.x * v.y - u.y * v.x));
}

double ProjectorMapping::meanDensity() const {
  constexpr int kSteps = 5;
  double sum = 0;
  for (int row = 0; row < kSteps; ++row) {
    for (int column = 0; column < kSteps; ++column) {
      sum += density({(column + 0.5) / kSteps * resolution_.width, (row + 0.5) / kSteps * resolution_.height});
    }
  }
  return sum / (kSteps * kSteps);
}

}  // namespace pixelflex::calib
