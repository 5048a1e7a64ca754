#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// The wall as a window into the model's space. Its frame of coordinates: the origin in the display's middle, x right,
/// y up, z from the wall towards the audience, wall units.
struct WallWindow {
  glm::dvec2 extent{1, 1};  // of the display, wall units
};

/// From where the wall is looked at, in the window's frame.
struct Viewer {
  glm::dvec3 eye{0, 0, 1};
  double eyeDistance = 0;  // between the two eyes, which lie side by side; wall units
};

/// Before the middle of the window, as far away as 1.2 times its longer side; eyes 1/40 of that distance apart, which
/// is a comfortable depth.
[[nodiscard]] Viewer centredViewer(const WallWindow& window);

enum class Eye { kMiddle, kLeft, kRight };
[[nodiscard]] glm::dvec3 eyeOf(const Viewer& viewer, Eye eye);

/// How the model stands in the window: turned about its middle, which is `shift` away from the window's middle.
struct ModelPose {
  double yaw = 0;             // degrees, to the right about the model's y
  double pitch = 0;           // degrees, its near side downwards
  double zoom = 1;            // 1: a ball around the model fills 0.9 of the window's shorter side
  glm::dvec3 shift{0, 0, 0};  // of that, window's shorter sides
  bool operator==(const ModelPose&) const = default;
};

[[nodiscard]] glm::dmat4 windowFromModel(const ModelPose& pose, const Bounds3& bounds, const WallWindow& window);

/// To clip coordinates whose x and y go from -1 to 1 over the display, y DOWNWARDS as rows of pictures do; depth from
/// -1 near to 1 far, just around what is to be seen. The off-axis frustum from the eye through the window.
[[nodiscard]] glm::dmat4 desktopFromWindow(const WallWindow& window, glm::dvec3 eye, glm::dvec3 middle, double radius);

/// Half the diagonal of the bounds in the window's units.
[[nodiscard]] double radiusInWindow(const ModelPose& pose, const Bounds3& bounds, const WallWindow& window);

/// What is shown of the model.
struct ModelView {
  WallWindow window;
  Viewer viewer;
  ModelPose pose;
  bool wireframe = false;
  bool axes = false;
  std::optional<glm::dvec4> cut;  // window's frame: shown where the product with (x, y, z, 1) is positive
};

}  // namespace pixelflex::viewer
