#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/image/image.h"

namespace pixelflex::viewer {

/// A model that cannot be shown; what() names the file, says what is wrong with it and what to do.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As the GPU gets it.
struct SceneVertex {
  glm::vec3 position{0};       // model units
  std::uint32_t normal = 0;    // unit, signed 10 bits for each of x, y and z, x lowest
  glm::vec2 texture{0};        // (0, 0) is the top-left corner of the picture
  std::uint32_t colour = ~0U;  // sRGB codes, red lowest, opacity highest; times the material's
  bool operator==(const SceneVertex&) const = default;
};

/// What is there of a surface: all of it, all where its picture is dense enough, or a share that lets see through.
enum class Solidity : std::uint8_t { kOpaque, kCutOut, kClear };

struct Material {
  glm::vec3 colour{0.8F};  // linear light
  int picture = -1;        // of Scene::pictures; times the colour
  bool lit = true;         // false: shows its colour as it is
  Solidity solidity = Solidity::kOpaque;
  float opacity = 1;      // times the picture's and the corners' fourth channel
  float cutoff = 0.5F;    // of kCutOut: what is less opaque is not there
  glm::vec3 emission{0};  // linear light
  glm::vec3 shine{0};     // of the lamp's light, what is thrown back where it is strongest
  float shininess = 1;    // exponent (Blinn): how small that place is
};

/// An upright box.
struct Bounds3 {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};

  void add(glm::vec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Bounds3& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  [[nodiscard]] glm::vec3 middle() const { return empty() ? glm::vec3(0) : 0.5F * (low + high); }
};

/// Triangles that lie together, of one material: what is drawn or left out as a whole.
struct ScenePart {
  std::uint32_t first = 0;  // index
  std::uint32_t count = 0;  // of indices
  std::int32_t material = 0;
  Bounds3 bounds;
};

/// One or several models in their common coordinates, everything checked: indices in range, coordinates finite.
struct Scene {
  std::vector<SceneVertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
  std::vector<ScenePart> parts;
  std::vector<Material> materials;
  std::vector<devices::Image8> pictures;  // three or four channels, sRGB codes, opacity
  std::vector<std::string> warnings;      // what of the files is not shown

  [[nodiscard]] Bounds3 bounds() const;
  [[nodiscard]] std::size_t triangles() const { return indices.size() / 3; }
  /// Adds another's parts. Throws ModelError when the vertices are more than an index can count.
  void append(Scene&& other);
};

/// More are refused: what they need in graphics memory, about 10 GiB, is more than usual cards have.
inline constexpr std::size_t kMostTriangles = 200'000'000;

/// The three arrows of a coordinate system, x red, y green, z blue, `length` long, not lit.
[[nodiscard]] Scene axesScene(float length);

}  // namespace pixelflex::viewer
