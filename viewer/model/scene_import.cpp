#include "viewer/model/scene_import.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "viewer/model/model_folder.h"
#include "viewer/model/scene_material.h"
#include "viewer/model/scene_pictures.h"
#include "viewer/model/triangle_soup.h"

namespace pixelflex::viewer {
namespace {

/// Deeper trees of nodes are no work of a person.
constexpr int kDeepestNode = 500;

struct Dropped {
  std::size_t corners = 0;
  std::size_t triangles = 0;
};

struct PlacedNode {
  const aiNode* node = nullptr;
  aiMatrix4x4 sceneFromNode;
  int depth = 0;
};

glm::vec3 toGlm(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

bool isFinite(glm::vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

float srgbFromLinear(float light) {
  return light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F;
}

bool isGltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".gltf" || extension == ".glb";
}

/// Assimp's scene, one mesh of it after the other, as ours.
class Conversion {
 public:
  Conversion(const aiScene& from, std::filesystem::path file)
      : from_(from), file_(std::move(file)), isGltf_(isGltf(file_)) {}

  Scene run() {
    takeMaterials();
    walk();
    report();
    return std::move(scene_);
  }

 private:
  void takeMaterials() {
    ScenePictures pictures(from_, file_, scene_);
    for (const aiMaterial* source : std::span(from_.mMaterials, from_.mNumMaterials)) {
      scene_.materials.push_back(materialOf(*source, pictures.of(*source), scene_.pictures, isGltf_));
    }
    if (scene_.materials.empty()) scene_.materials.emplace_back();
  }

  void walk() {
    std::vector<PlacedNode> waiting{{from_.mRootNode, from_.mRootNode->mTransformation, 0}};
    while (!waiting.empty()) {
      const PlacedNode place = waiting.back();
      waiting.pop_back();
      if (place.depth > kDeepestNode) fail("its nodes are nested more than 500 deep; it is damaged");
      for (const unsigned mesh : std::span(place.node->mMeshes, place.node->mNumMeshes)) {
        if (mesh >= from_.mNumMeshes) fail("a node names a mesh that is not there; it is damaged");
        takeMesh(*from_.mMeshes[mesh], place.sceneFromNode);
      }
      for (const aiNode* child : std::span(place.node->mChildren, place.node->mNumChildren)) {
        waiting.push_back({child, place.sceneFromNode * child->mTransformation, place.depth + 1});
      }
    }
  }

  void takeMesh(const aiMesh& mesh, const aiMatrix4x4& sceneFromMesh) {
    if (scene_.triangles() + mesh.mNumFaces > kMostTriangles)
      fail("more than 200 million triangles; show a smaller model");
    aiMatrix3x3 turned(sceneFromMesh);
    turned.Inverse().Transpose();
    TriangleSoup soup;
    soup.reserve(std::size_t{3} * mesh.mNumFaces);
    bool normals = mesh.HasNormals();
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
      if (face.mNumIndices != 3) continue;
      std::array<SoupCorner, 3> corners;
      std::size_t sound = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices) fail("a triangle names a vertex that is not there; it is damaged");
        corners[i] = cornerOf(mesh, face.mIndices[i], sceneFromMesh, turned);
        if (isFinite(corners[i].position)) ++sound;
        normals = normals && isFinite(corners[i].normal);
      }
      dropped_.corners += 3 - sound;
      dropped_.triangles += sound < 3 ? 1 : 0;
      if (sound == 3) soup.insert(soup.end(), corners.begin(), corners.end());
    }
    if (!normals) computeNormals(soup);
    addToScene(soup, static_cast<int>(std::min(mesh.mMaterialIndex, materialCount() - 1)), scene_);
  }

  [[nodiscard]] unsigned materialCount() const { return static_cast<unsigned>(scene_.materials.size()); }

  [[nodiscard]] SoupCorner cornerOf(const aiMesh& mesh, unsigned i, const aiMatrix4x4& sceneFromMesh,
                                    const aiMatrix3x3& turned) const {
    SoupCorner corner{.position = toGlm(sceneFromMesh * mesh.mVertices[i])};
    if (mesh.HasNormals()) corner.normal = toGlm((turned * mesh.mNormals[i]).NormalizeSafe());
    if (mesh.HasTextureCoords(0)) {
      const aiVector3D& at = mesh.mTextureCoords[0][i];
      corner.texture = {std::isfinite(at.x) ? at.x : 0, std::isfinite(at.y) ? 1 - at.y : 0};
    }
    if (mesh.HasVertexColors(0)) corner.colour = codesOf(mesh.mColors[0][i]);
    return corner;
  }

  [[nodiscard]] std::uint32_t codesOf(const aiColor4D& colour) const {
    // Others than glTF have a fourth number there that means nothing as often as not.
    std::uint32_t codes = static_cast<std::uint32_t>(std::lround(255 * (isGltf_ ? held(colour.a) : 1))) << 24U;
    for (unsigned c = 0; c < 3; ++c) {
      const float value = held(colour[c]);
      codes |= static_cast<std::uint32_t>(std::lround(255 * (isGltf_ ? srgbFromLinear(value) : value))) << (8 * c);
    }
    return codes;
  }

  void report() {
    if (dropped_.triangles > 0) {
      scene_.warnings.push_back(file_.string() + ": " + std::to_string(dropped_.corners) +
                                " corners have coordinates that are no numbers; their " +
                                std::to_string(dropped_.triangles) + " triangles are left out");
    }
    if (scene_.indices.empty()) fail("there is not a single triangle in it to show");
  }

  [[noreturn]] void fail(const std::string& what) const { throw ModelError(file_.string() + ": " + what); }

  const aiScene& from_;
  std::filesystem::path file_;
  bool isGltf_;
  Scene scene_;
  Dropped dropped_;
};

/// Nothing but files of the model's folder.
class ModelFiles : public Assimp::DefaultIOSystem {
 public:
  explicit ModelFiles(std::filesystem::path model) : model_(std::move(model)) {}
  bool Exists(const char* path) const override {
    return isOfModel(model_, path) && Assimp::DefaultIOSystem::Exists(path);
  }
  Assimp::IOStream* Open(const char* path, const char* mode) override {
    if (isOfModel(model_, path)) return Assimp::DefaultIOSystem::Open(path, mode);
    missed_.insert(path);
    return nullptr;
  }
  /// What the reader would have liked to open.
  [[nodiscard]] const std::set<std::string>& missed() const { return missed_; }

 private:
  std::set<std::string> missed_;
  std::filesystem::path model_;
};

}  // namespace

Scene importScene(const std::filesystem::path& file) {
  Assimp::Importer importer;
  auto* files = new ModelFiles(file);
  importer.SetIOHandler(files);  // which the importer owns from here on
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw ModelError(
        file.string() + ": cannot be read: " + importer.GetErrorString() +
        "; it is damaged, or of a format that is not known (OBJ, PLY, STL and glTF are among those that are)");
  }
  Scene converted = Conversion(*scene, file).run();
  for (const auto& missed : files->missed()) {
    converted.warnings.push_back(file.string() + ": names " + missed + ", which is no file of the model's folder");
  }
  return converted;
}

}  // namespace pixelflex::viewer
