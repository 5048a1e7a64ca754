#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "devices/display/gl_handle.h"
#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// Triangles that let see through and so must be drawn from the back to the front, by their middles. Needs its context
/// current.
class ClearTriangles {
 public:
  /// Triangles of one material, one after the other in buffer().
  struct Run {
    int material = 0;
    std::size_t first = 0;  // triangle
    std::size_t count = 0;
  };

  void add(const Scene& scene, const ScenePart& part);
  /// In model coordinates. Sorts only when the eye is another than the last time.
  [[nodiscard]] const std::vector<Run>& fromTheBack(glm::vec3 eye);
  /// Indices of the scene's vertices in the order of the last runs.
  [[nodiscard]] devices::GlName buffer() const { return buffer_.get(); }

 private:
  struct Triangle {
    glm::vec3 middle;
    glm::uvec3 corners;
    int material;
  };
  void upload(const std::vector<std::uint32_t>& order);

  std::vector<Triangle> triangles_;
  std::vector<Run> runs_;
  std::optional<glm::vec3> sortedFor_;
  devices::GlBuffer buffer_;
};

}  // namespace pixelflex::viewer
