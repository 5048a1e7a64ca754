#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// A triangle's corner before corners are shared.
struct SoupCorner {
  glm::vec3 position{0};
  glm::vec3 normal{0};
  glm::vec2 texture{0};
  std::uint32_t colour = ~0U;  // as SceneVertex's
};

/// Triangles of one material, three corners each.
using TriangleSoup = std::vector<SoupCorner>;

/// Gives every corner a unit normal: the mean, weighted by area, of the triangles that meet in its place and are turned
/// less than 60 degrees from its own, so that what is round looks round and edges stay edges.
void computeNormals(TriangleSoup& soup);

/// Adds the triangles to the scene: equal corners become one vertex, triangles that lie together one part.
void addToScene(const TriangleSoup& soup, int material, Scene& scene);

}  // namespace pixelflex::viewer
