#include "viewer/model/model_view.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace pixelflex::viewer {
namespace {

double shorterSide(const WallWindow& window) {
  return std::min(window.extent.x, window.extent.y);
}

double modelRadius(const Bounds3& bounds) {
  const double radius = bounds.empty() ? 0 : 0.5 * glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
  return radius > 0 ? radius : 1;
}

/// Window units per model unit.
double scaleOf(const ModelPose& pose, const Bounds3& bounds, const WallWindow& window) {
  return pose.zoom * 0.45 * shorterSide(window) / modelRadius(bounds);
}

}  // namespace

Viewer centredViewer(const WallWindow& window) {
  const double distance = 1.2 * std::max(window.extent.x, window.extent.y);
  return {.eye = {0, 0, distance}, .eyeDistance = distance / 40};
}

glm::dvec3 eyeOf(const Viewer& viewer, Eye eye) {
  const double side = eye == Eye::kMiddle ? 0 : eye == Eye::kLeft ? -0.5 : 0.5;
  return viewer.eye + glm::dvec3(side * viewer.eyeDistance, 0, 0);
}

glm::dmat4 windowFromModel(const ModelPose& pose, const Bounds3& bounds, const WallWindow& window) {
  glm::dmat4 matrix(1);
  matrix = glm::translate(matrix, shorterSide(window) * pose.shift);
  matrix = glm::scale(matrix, glm::dvec3(scaleOf(pose, bounds, window)));
  matrix = glm::rotate(matrix, glm::radians(pose.pitch), glm::dvec3(1, 0, 0));
  matrix = glm::rotate(matrix, glm::radians(pose.yaw), glm::dvec3(0, 1, 0));
  const glm::dvec3 middle = bounds.empty() ? glm::dvec3(0) : 0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high));
  return glm::translate(matrix, -middle);
}

double radiusInWindow(const ModelPose& pose, const Bounds3& bounds, const WallWindow& window) {
  return modelRadius(bounds) * scaleOf(pose, bounds, window);
}

glm::dmat4 desktopFromWindow(const WallWindow& window, glm::dvec3 eye, glm::dvec3 middle, double radius) {
  const double towards = eye.z - middle.z;
  const double far = std::max(1.001 * (towards + radius), 0.02 * eye.z);
  const double near = std::max(0.999 * (towards - radius), std::max(0.01 * eye.z, far / 10'000));
  // What is on the wall keeps its place: the window's edges as the eye sees them, at the near plane's distance.
  const double atNear = near / eye.z;
  const glm::dvec2 low = (-0.5 * window.extent - glm::dvec2(eye)) * atNear;
  const glm::dvec2 high = (0.5 * window.extent - glm::dvec2(eye)) * atNear;
  const auto frustum = glm::frustum(low.x, high.x, low.y, high.y, near, std::max(far, 1.01 * near));
  const auto downwards = glm::scale(glm::dmat4(1), glm::dvec3(1, -1, 1));
  return downwards * frustum * glm::translate(glm::dmat4(1), -eye);
}

}  // namespace pixelflex::viewer
