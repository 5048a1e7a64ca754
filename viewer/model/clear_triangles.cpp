#include "viewer/model/clear_triangles.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

namespace pixelflex::viewer {

void ClearTriangles::add(const Scene& scene, const ScenePart& part) {
  for (std::size_t i = part.first; i < std::size_t{part.first} + part.count; i += 3) {
    const glm::uvec3 corners(scene.indices[i], scene.indices[i + 1], scene.indices[i + 2]);
    const auto at = [&](unsigned corner) { return scene.vertices[corner].position / 3.0F; };
    triangles_.push_back({at(corners.x) + at(corners.y) + at(corners.z), corners, part.material});
  }
}

const std::vector<ClearTriangles::Run>& ClearTriangles::fromTheBack(glm::vec3 eye) {
  if (sortedFor_ == eye) return runs_;
  sortedFor_ = eye;
  std::vector<float> distance;
  for (const auto& triangle : triangles_) distance.push_back(glm::distance(triangle.middle, eye));
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::uint32_t i) { return distance[i]; });
  upload(order);
  return runs_;
}

void ClearTriangles::upload(const std::vector<std::uint32_t>& order) {
  std::vector<glm::uvec3> corners;
  runs_.clear();
  for (const auto i : order) {
    const Triangle& triangle = triangles_[i];
    if (runs_.empty() || runs_.back().material != triangle.material) {
      runs_.push_back({.material = triangle.material, .first = corners.size()});
    }
    ++runs_.back().count;
    corners.push_back(triangle.corners);
  }
  if (!buffer_) buffer_ = devices::GlBuffer::create();
  glNamedBufferData(buffer_.get(), static_cast<GLsizeiptr>(corners.size() * sizeof(glm::uvec3)), corners.data(),
                    GL_DYNAMIC_DRAW);
}

}  // namespace pixelflex::viewer
