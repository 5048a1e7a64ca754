#include "calib/simulate/placed_optics.h"

#include <cmath>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace pixelflex::calib {

glm::dmat3 roomFromDevice(glm::dvec3 rotation) {
  const double yaw = glm::radians(rotation.x);
  const double pitch = glm::radians(rotation.y);
  const double roll = glm::radians(rotation.z);
  // GLM's constructors take columns: where the x, y and z axes go.
  const glm::dmat3 aboutY({std::cos(yaw), 0, -std::sin(yaw)}, {0, 1, 0}, {std::sin(yaw), 0, std::cos(yaw)});
  const glm::dmat3 aboutX({1, 0, 0}, {0, std::cos(pitch), std::sin(pitch)}, {0, -std::sin(pitch), std::cos(pitch)});
  const glm::dmat3 aboutZ({std::cos(roll), std::sin(roll), 0}, {-std::sin(roll), std::cos(roll), 0}, {0, 0, 1});
  return aboutY * aboutX * aboutZ;
}

PlacedOptics::PlacedOptics(const Pose& pose, const Optics& optics)
    : position_(pose.position), roomFromDevice_(roomFromDevice(pose.rotation)), lens_(optics) {}

std::optional<glm::dvec3> PlacedOptics::direction(glm::dvec2 pixel) const {
  const auto ray = lens_.rayFromPixel(pixel);
  if (!ray) return std::nullopt;
  return roomFromDevice_ * glm::dvec3(*ray, 1);
}

std::optional<glm::dvec2> PlacedOptics::pixelFromRoom(glm::dvec3 point) const {
  const glm::dvec3 inDevice = (point - position_) * roomFromDevice_;  // times the transpose
  if (inDevice.z <= 1e-6) return std::nullopt;
  return lens_.pixelFromRay(glm::dvec2(inDevice) / inDevice.z);
}

std::optional<glm::dvec2> PlacedOptics::wallFromPixel(const Screen& screen, glm::dvec2 pixel) const {
  const auto along = direction(pixel);
  if (!along) return std::nullopt;
  const auto point = screen.hit(position_, *along);
  if (!point) return std::nullopt;
  return screen.wallFromRoom(*point);
}

std::optional<glm::dvec2> PlacedOptics::pixelFromWall(const Screen& screen, glm::dvec2 pointInWall) const {
  if (!screen.isVisible(position_, pointInWall)) return std::nullopt;
  return pixelFromRoom(screen.roomFromWall(pointInWall));
}

}  // namespace pixelflex::calib
