#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "viewer/model/clear_triangles.h"
#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// What a drawing sent to the GPU.
struct DrawnParts {
  std::size_t parts = 0;
  std::size_t triangles = 0;
};

/// Through which matrices a scene is seen.
struct SceneSight {
  glm::dmat4 desktopFromModel{1};    // to clip coordinates
  glm::dmat4 projectorFromModel{1};  // likewise
  bool cull = true;                  // what lies outside of either is left out
  bool solid = false;                // what lets see through is taken as solid
};

/// Triangles of one material that are drawn by one call.
struct SceneGroup {
  int material = 0;
  bool across = false;  // they may reach over the desktop's borders
  std::vector<int> counts;
  std::vector<const void*> offsets;
  DrawnParts drawn;
};

/// A scene in graphics memory, once for all projectors. Needs its context, or one that shares with it, current.
class SceneBuffers {
 public:
  /// Keeps nothing of the scene's vertices and pictures in this process. Throws RendererError when they do not fit.
  explicit SceneBuffers(Scene scene);

  /// What may be seen of all that is solid; the order does not matter.
  [[nodiscard]] std::vector<SceneGroup> solidGroups(const SceneSight& sight) const;
  /// What lets see through, from the back to the front; none, when nothing of it may be seen.
  [[nodiscard]] std::vector<SceneGroup> clearGroups(const SceneSight& sight, glm::vec3 eyeInModel);
  void drawSolid(const SceneGroup& group) const;
  void drawClear(const SceneGroup& group) const;

  [[nodiscard]] const Material& material(int number) const { return materials_[static_cast<std::size_t>(number)]; }
  /// Makes the material's uniforms of a program that is in use, and its picture the one of unit 0. shaders/model.*
  /// knows them.
  void setMaterial(const devices::GlProgram& program, int number) const;

  [[nodiscard]] const Bounds3& bounds() const { return bounds_; }
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  /// In graphics memory, without pictures.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void makeVertexArray();
  [[nodiscard]] bool isSeen(const ScenePart& part, const SceneSight& sight) const;

  std::vector<ScenePart> parts_;  // by material
  std::vector<Material> materials_;
  Bounds3 bounds_;
  std::size_t triangles_ = 0;
  std::size_t bytes_ = 0;
  ClearTriangles clear_;
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
