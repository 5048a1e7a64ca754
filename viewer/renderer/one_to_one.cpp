#include "viewer/renderer/one_to_one.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace pixelflex::viewer {
namespace {

constexpr double kTolerance = 0.01;  // pixels

struct Corner {
  glm::dvec2 inProjector;
  glm::dvec3 weighted;
  [[nodiscard]] glm::dvec2 inDesktop() const { return glm::dvec2(weighted) / weighted.z; }
};
using Triangle = std::array<Corner, 3>;

Corner cornerOf(const WarpVertex& vertex) {
  return {{vertex.x, vertex.y}, {vertex.uw, vertex.vw, vertex.w}};
}

Corner between(const Corner& a, const Corner& b) {
  return {(a.inProjector + b.inProjector) / 2.0, (a.weighted + b.weighted) / 2.0};
}

/// desktop = turn * projector + shift, with entries of 0 and +-1 and a whole shift.
struct PixelMap {
  glm::dmat2 turn{1};
  glm::dvec2 shift{0, 0};

  [[nodiscard]] bool fits(const Corner& corner) const {
    const auto apart = glm::abs(turn * corner.inProjector + shift - corner.inDesktop());
    return std::max(apart.x, apart.y) <= kTolerance;
  }
  /// On a triangle that this map fits at the corners it may still be off between them, most of all half-way, where the
  /// weights differ.
  [[nodiscard]] bool fits(const Triangle& t) const {
    return fits(t[0]) && fits(t[1]) && fits(t[2]) && fits(between(t[0], t[1])) && fits(between(t[1], t[2])) &&
           fits(between(t[2], t[0]));
  }
};

/// The only map that a triangle can have; none for a sliver or when it scales or turns otherwise.
std::optional<PixelMap> mapOf(const Triangle& t) {
  const glm::dmat2 sides(t[1].inProjector - t[0].inProjector, t[2].inProjector - t[0].inProjector);
  if (std::abs(glm::determinant(sides)) < 1) return std::nullopt;
  const glm::dmat2 turned(t[1].inDesktop() - t[0].inDesktop(), t[2].inDesktop() - t[0].inDesktop());
  PixelMap map;
  map.turn = turned * glm::inverse(sides);
  for (int column = 0; column < 2; ++column) map.turn[column] = glm::round(map.turn[column]);
  const bool keepsSize =
      glm::abs(map.turn[0]) + glm::abs(map.turn[1]) == glm::dvec2(1, 1) && std::abs(glm::determinant(map.turn)) == 1;
  if (!keepsSize) return std::nullopt;
  map.shift = glm::round(t[0].inDesktop() - map.turn * t[0].inProjector);
  return map;
}

std::vector<Triangle> trianglesOf(const WarpMesh& mesh) {
  std::vector<Triangle> triangles;
  const auto corner = [&mesh](std::size_t index) { return cornerOf(mesh.vertices[mesh.indices[index]]); };
  for (const auto& patch : mesh.patches) {
    for (std::size_t i = patch.firstIndex; i < std::size_t{patch.firstIndex} + patch.indexCount; i += 3) {
      triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    }
  }
  return triangles;
}

}  // namespace

bool showsPixelsOneToOne(const WarpMesh& mesh) {
  const auto triangles = trianglesOf(mesh);
  std::optional<PixelMap> map;
  for (std::size_t i = 0; i < triangles.size() && !map; ++i) map = mapOf(triangles[i]);
  return map && std::ranges::all_of(triangles, [&map](const Triangle& triangle) { return map->fits(triangle); });
}

}  // namespace pixelflex::viewer
