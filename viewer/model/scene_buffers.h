#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// What a drawing sent to the GPU.
struct DrawnParts {
  std::size_t parts = 0;
  std::size_t triangles = 0;
};

/// A scene in graphics memory, once for all projectors. Needs its context, or one that shares with it, current.
class SceneBuffers {
 public:
  /// Keeps nothing of the scene's vertices and pictures in this process. Throws RendererError when they do not fit.
  explicit SceneBuffers(Scene scene);

  /// Draws what may lie inside the clip volumes of both matrices; `program` is in use. shaders/model.* knows the
  /// uniforms.
  DrawnParts draw(const devices::GlProgram& program, const glm::dmat4& desktopFromModel,
                  const glm::dmat4& projectorFromModel) const;
  /// Everything, in one call for each material.
  DrawnParts drawAll(const devices::GlProgram& program) const;

  [[nodiscard]] const Bounds3& bounds() const { return bounds_; }
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  /// In graphics memory, without pictures.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  DrawnParts drawParts(const devices::GlProgram& program, const std::vector<const ScenePart*>& parts) const;
  void setMaterial(const devices::GlProgram& program, const Material& material) const;

  std::vector<ScenePart> parts_;  // by material
  std::vector<Material> materials_;
  Bounds3 bounds_;
  std::size_t triangles_ = 0;
  std::size_t bytes_ = 0;
  devices::GlBuffer vertices_;
  devices::GlBuffer indices_;
  devices::GlVertexArray vertexArray_;
  std::vector<devices::GlTexture> pictures_;
};

/// Whether a box, seen through a matrix, lies wholly beyond one side of the clip volume.
[[nodiscard]] bool isOutside(const Bounds3& bounds, const glm::dmat4& clipFromModel, double slack);
/// Whether it lies wholly within.
[[nodiscard]] bool isInside(const Bounds3& bounds, const glm::dmat4& clipFromModel);

}  // namespace pixelflex::viewer
