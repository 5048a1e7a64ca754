#include "tests/fuzz/model_entry.h"

#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.h"
#include "viewer/model/scene_file.h"
#include "viewer/model/scene_import.h"

namespace pixelflex::testing {
namespace {

std::string nameFor(std::uint8_t kind) {
  switch (kind) {
    case 'p':
      return "model.ply";
    case 's':
      return "model.stl";
    case 'g':
      return "model.gltf";
    case 'b':
      return "model.glb";
    default:
      return "model.obj";
  }
}

void require(bool sound, const char* what) {
  if (!sound) throw std::logic_error(what);
}

void requireSound(const viewer::Scene& scene) {
  require(!scene.indices.empty() && scene.indices.size() % 3 == 0, "no triangles");
  for (const auto index : scene.indices) require(index < scene.vertices.size(), "an index without its vertex");
  for (const auto& vertex : scene.vertices) {
    for (int axis = 0; axis < 3; ++axis) require(std::isfinite(vertex.position[axis]), "a place that is no number");
  }
  for (const auto& part : scene.parts) {
    require(std::size_t{part.first} + part.count <= scene.indices.size(), "a part beyond the indices");
    require(static_cast<std::size_t>(part.material) < scene.materials.size(), "a part without its material");
  }
  for (const auto& material : scene.materials) {
    require(material.picture < static_cast<int>(scene.pictures.size()), "a material without its picture");
  }
}

}  // namespace

std::size_t readModel(std::span<const std::uint8_t> bytes) {
  static const TemporaryFolder folder;
  if (bytes.empty()) return 0;
  const std::filesystem::path file = folder / nameFor(bytes.front());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()) + 1, static_cast<std::streamsize>(bytes.size() - 1));
  try {
    viewer::checkModelFile(file);  // here, so that a fuzzer sees its ways
    const viewer::Scene scene = viewer::loadScene(std::array{file});
    requireSound(scene);
    return scene.triangles();
  } catch (const viewer::ModelError& error) {
    require(std::string(error.what()).find(file.string()) != std::string::npos, "an error that does not name the file");
    return 0;
  }
}

}  // namespace pixelflex::testing
