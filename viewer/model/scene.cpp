#include "viewer/model/scene.h"

#include <array>
#include <iterator>
#include <utility>

namespace pixelflex::viewer {
namespace {

template <class T>
void moveOnto(std::vector<T>& all, std::vector<T>&& more) {
  if (all.empty()) {
    all = std::move(more);
    return;
  }
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// A bar along one axis, from the origin.
void addBar(Scene& scene, int axis, float length) {
  const auto base = static_cast<std::uint32_t>(scene.vertices.size());
  const std::uint32_t colour = 0xFF000000U | (0xFFU << (8 * axis));
  for (int corner = 0; corner < 8; ++corner) {
    glm::vec3 p;
    for (int i = 0; i < 3; ++i) {
      const bool far = ((corner >> i) & 1) != 0;
      p[i] = i == axis ? (far ? length : 0) : (far ? 0.01F : -0.01F) * length;
    }
    scene.vertices.push_back({.position = p, .colour = colour});
  }
  constexpr std::array<std::uint32_t, 36> kSides{0, 1, 3, 0, 3, 2, 4, 7, 5, 4, 6, 7, 0, 5, 1, 0, 4, 5,
                                                 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 7, 3, 1, 5, 7};
  for (const auto index : kSides) scene.indices.push_back(base + index);
}

}  // namespace

Bounds3 Scene::bounds() const {
  Bounds3 all;
  for (const auto& part : parts) all.add(part.bounds);
  return all;
}

void Scene::append(Scene&& other) {
  if (triangles() + other.triangles() > kMostTriangles ||
      vertices.size() + other.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw ModelError("the models together have more than " + std::to_string(kMostTriangles) +
                     " triangles: show fewer of them");
  }
  const auto vertexBase = static_cast<std::uint32_t>(vertices.size());
  const auto indexBase = static_cast<std::uint32_t>(indices.size());
  const auto materialBase = static_cast<std::int32_t>(materials.size());
  const auto pictureBase = static_cast<int>(pictures.size());
  for (auto& index : other.indices) index += vertexBase;
  for (auto& part : other.parts) {
    part.first += indexBase;
    part.material += materialBase;
  }
  for (auto& material : other.materials) {
    if (material.picture >= 0) material.picture += pictureBase;
  }
  moveOnto(vertices, std::move(other.vertices));
  moveOnto(indices, std::move(other.indices));
  moveOnto(parts, std::move(other.parts));
  moveOnto(materials, std::move(other.materials));
  moveOnto(pictures, std::move(other.pictures));
  moveOnto(warnings, std::move(other.warnings));
}

Scene axesScene(float length) {
  Scene scene;
  for (int axis = 0; axis < 3; ++axis) addBar(scene, axis, length);
  scene.materials.push_back({.colour = glm::vec3(1), .lit = false});
  ScenePart part{.count = static_cast<std::uint32_t>(scene.indices.size())};
  for (const auto& vertex : scene.vertices) part.bounds.add(vertex.position);
  scene.parts.push_back(part);
  return scene;
}

}  // namespace pixelflex::viewer
