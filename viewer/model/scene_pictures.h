#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "viewer/model/scene.h"

struct aiMaterial;
struct aiScene;
struct aiTexture;

namespace pixelflex::viewer {

/// The pictures that a model's materials name: files beside it, or parts of it.
class ScenePictures {
 public:
  /// Pictures and warnings go into `into`. References are kept.
  ScenePictures(const aiScene& from, const std::filesystem::path& file, Scene& into)
      : from_(from), file_(file), into_(into) {}

  /// The number in Scene::pictures of the one that colours the material, with the opacity that another gives; -1: none,
  /// or one that cannot be read, of which is warned once.
  [[nodiscard]] int of(const aiMaterial& material);

 private:
  [[nodiscard]] int numberOf(const std::string& name, const std::string& opacity);
  [[nodiscard]] int load(const std::string& name, const std::string& opacity);
  [[nodiscard]] devices::Image8 checked(const std::string& name) const;
  [[nodiscard]] devices::Image8 read(const std::string& name) const;

  const aiScene& from_;
  const std::filesystem::path& file_;
  Scene& into_;
  std::map<std::pair<std::string, std::string>, int> known_;  // by name, and that of its opacity
};

/// Whether there is a pixel in it that is not opaque.
[[nodiscard]] bool letsSeeThrough(const devices::Image8& picture);
/// Whether every pixel of it is either there or not, but for those at borders.
[[nodiscard]] bool isCutOut(const devices::Image8& picture);

/// Wider or higher ones are left out.
inline constexpr int kLargestPicture = 16384;

}  // namespace pixelflex::viewer
