#include "calib/geometry/projector_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "calib/geometry/nudge_map.h"

namespace pixelflex::calib {

ProjectorMapping::ProjectorMapping(const ProjectorModel& model, devices::Size resolution)
    : view_(Homography(model.projectorFromWall), model.bend),
      lens_(model.radial, model.tangential),
      residual_(model.residual ? ResidualMap(*model.residual, resolution) : ResidualMap()),
      centre_(model.centre),
      scale_(model.scale),
      resolution_(resolution),
      largestRadius_(0),
      sign_(1) {
  const double w = resolution.width;
  const double h = resolution.height;
  for (const glm::dvec2 corner : std::array<glm::dvec2, 5>{{{0, 0}, {w, 0}, {w, h}, {0, h}, {w / 2, h / 2}}}) {
    const glm::dvec2 ideal = idealFromMeasured(corner).value_or((corner - centre_) / scale_);
    largestRadius_ = std::max(largestRadius_, glm::length(ideal));
  }
  largestRadius_ *= 1.1;
  const glm::dvec2 middle{w / 2, h / 2};
  const glm::dvec2 ideal = idealFromMeasured(middle).value_or((middle - centre_) / scale_);
  middleInWall_ = view_.wallFromImage(ideal).value_or(glm::dvec2(0));
  sign_ = view_.weight(middleInWall_) < 0 ? -1 : 1;
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

std::optional<glm::dvec2> ProjectorMapping::idealFromMeasured(glm::dvec2 pointInMeasured) const {
  const auto distorted = residual_.invert(pointInMeasured);
  return distorted ? lens_.undistort((*distorted - centre_) / scale_) : std::nullopt;
}

std::optional<glm::dvec2> ProjectorMapping::wallFromMeasured(glm::dvec2 pointInMeasured) const {
  const auto ideal = idealFromMeasured(pointInMeasured);
  const auto pointInWall = ideal ? view_.wallFromImage(*ideal) : std::nullopt;
  if (!pointInWall || !std::isfinite(pointInWall->x) || !std::isfinite(pointInWall->y)) return std::nullopt;
  if (view_.weight(*pointInWall) * sign_ <= 0) return std::nullopt;
  return pointInWall;
}

std::optional<glm::dvec2> ProjectorMapping::projectorFromWall(glm::dvec2 pointInWall) const {
  if (view_.weight(pointInWall) * sign_ <= 0) return std::nullopt;
  const glm::dvec2 ideal = view_.imageFromWall(pointInWall);
  if (glm::dot(ideal, ideal) > largestRadius_ * largestRadius_) return std::nullopt;
  return nudgedFromMeasured_.map(residual_.apply(lens_.distort(ideal) * scale_ + centre_));
}

Homography ProjectorMapping::flatWallFromProjector() const {
  return view_.imageFromTangent(middleInWall_).inverse() * Homography::scaling(glm::dvec2(1 / scale_)) *
         Homography::translation(-centre_) * measuredFromNudged_;
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
