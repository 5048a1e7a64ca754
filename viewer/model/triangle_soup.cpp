#include "viewer/model/triangle_soup.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>
#include <numeric>
#include <span>
#include <string_view>
#include <unordered_map>

namespace pixelflex::viewer {
namespace {

/// A part has no more triangles, unless they all lie in one place.
constexpr std::size_t kPartTriangles = 2048;

struct BytesHash {
  template <class T>
  std::size_t operator()(const T& value) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(&value), sizeof(T)});
  }
};

struct BytesEqual {
  template <class T>
  bool operator()(const T& a, const T& b) const {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
  }
};

/// Values to numbers in order of their first coming. T has no padding.
template <class T>
class Numbering {
 public:
  explicit Numbering(std::size_t expected) { numbers_.reserve(expected); }
  std::uint32_t of(const T& value) {
    return numbers_.emplace(value, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  std::unordered_map<T, std::uint32_t, BytesHash, BytesEqual> numbers_;
};

/// Twice the area long.
glm::vec3 faceNormal(std::span<const SoupCorner> triangle) {
  return glm::cross(triangle[1].position - triangle[0].position, triangle[2].position - triangle[0].position);
}

glm::vec3 unit(glm::vec3 v) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : glm::vec3(0, 0, 1);
}

/// For each place the corners that lie there: those of place i are [begin[i], begin[i + 1]) of `corners`.
struct Places {
  std::vector<std::uint32_t> ofCorner;
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> corners;
};

Places placesOf(const TriangleSoup& soup) {
  Places places;
  Numbering<glm::vec3> numbers(soup.size() / 4);
  // Adding zero makes one of the two zeros.
  for (const auto& corner : soup) places.ofCorner.push_back(numbers.of(corner.position + 0.0F));
  places.begin.assign(numbers.size() + 1, 0);
  for (const auto place : places.ofCorner) ++places.begin[place + 1];
  std::partial_sum(places.begin.begin(), places.begin.end(), places.begin.begin());
  places.corners.resize(soup.size());
  auto next = places.begin;
  for (std::uint32_t i = 0; i < soup.size(); ++i) places.corners[next[places.ofCorner[i]]++] = i;
  return places;
}

SceneVertex vertexOf(const SoupCorner& corner) {
  return {.position = corner.position,
          .normal = glm::packSnorm3x10_1x2(glm::vec4(corner.normal, 0)),
          .texture = corner.texture,
          .colour = corner.colour};
}

/// Halves the triangles across their longest extent until they are few.
class Splitter {
 public:
  Splitter(const TriangleSoup& soup, std::vector<std::uint32_t>& triangles) : soup_(soup), triangles_(triangles) {}

  void split(std::size_t first, std::size_t last, std::vector<ScenePart>& parts) {
    Bounds3 bounds;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner)
        bounds.add(soup_[3 * std::size_t{triangles_[i]} + corner].position);
    }
    if (last - first <= kPartTriangles) {
      parts.push_back(
          {static_cast<std::uint32_t>(3 * first), static_cast<std::uint32_t>(3 * (last - first)), 0, bounds});
      return;
    }
    const glm::vec3 extent = bounds.high - bounds.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t middle = (first + last) / 2;
    const auto begin = triangles_.begin();
    std::nth_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
                     begin + static_cast<std::ptrdiff_t>(last),
                     [&](std::uint32_t a, std::uint32_t b) { return place(a, axis) < place(b, axis); });
    split(first, middle, parts);
    split(middle, last, parts);
  }

 private:
  [[nodiscard]] float place(std::uint32_t triangle, int axis) const {
    const SoupCorner* corner = &soup_[3 * std::size_t{triangle}];
    return corner[0].position[axis] / 3 + corner[1].position[axis] / 3 + corner[2].position[axis] / 3;
  }
  const TriangleSoup& soup_;
  std::vector<std::uint32_t>& triangles_;
};

}  // namespace

void computeNormals(TriangleSoup& soup) {
  const Places places = placesOf(soup);
  std::vector<glm::vec3> faces(soup.size() / 3);
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = faceNormal(std::span(soup).subspan(3 * i, 3));
  constexpr float kSmooth = 0.5F;  // cosine of 60 degrees
  for (std::size_t i = 0; i < soup.size(); ++i) {
    const glm::vec3 own = unit(faces[i / 3]);
    glm::vec3 sum = faces[i / 3];
    const auto place = places.ofCorner[i];
    for (auto k = places.begin[place]; k < places.begin[place + 1]; ++k) {
      const glm::vec3 face = faces[places.corners[k] / 3];
      if (places.corners[k] / 3 != i / 3 && glm::dot(unit(face), own) > kSmooth) sum += face;
    }
    soup[i].normal = unit(sum);
  }
}

void addToScene(const TriangleSoup& soup, int material, Scene& scene) {
  std::vector<std::uint32_t> triangles(soup.size() / 3);
  std::iota(triangles.begin(), triangles.end(), 0U);
  std::vector<ScenePart> parts;
  if (!triangles.empty()) Splitter(soup, triangles).split(0, triangles.size(), parts);
  const auto vertexBase = static_cast<std::uint32_t>(scene.vertices.size());
  const auto indexBase = static_cast<std::uint32_t>(scene.indices.size());
  for (auto& part : parts) {
    part.first += indexBase;
    part.material = material;
  }
  scene.parts.insert(scene.parts.end(), parts.begin(), parts.end());
  static_assert(sizeof(SceneVertex) == 28);
  Numbering<SceneVertex> numbers(soup.size() / 4);
  for (const auto triangle : triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const SceneVertex vertex = vertexOf(soup[3 * std::size_t{triangle} + corner]);
      const auto known = numbers.size();
      const auto number = numbers.of(vertex);
      if (number == known) scene.vertices.push_back(vertex);
      scene.indices.push_back(vertexBase + number);
    }
  }
}

}  // namespace pixelflex::viewer
