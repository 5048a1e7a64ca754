#include "viewer/model/scene_material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <cmath>
#include <glm/common.hpp>
#include <string_view>

#include "viewer/model/scene_pictures.h"

namespace pixelflex::viewer {
namespace {

float linearFromSrgb(float code) {
  return code <= 0.04045F ? code / 12.92F : std::pow((code + 0.055F) / 1.055F, 2.4F);
}

glm::vec3 lightOf(const aiColor4D& colour, bool isLight) {
  const glm::vec3 value(held(colour.r), held(colour.g), held(colour.b));
  if (isLight) return value;
  return {linearFromSrgb(value.r), linearFromSrgb(value.g), linearFromSrgb(value.b)};
}

float numberOf(const aiMaterial& source, const char* key, unsigned type, unsigned index, float otherwise) {
  float value = otherwise;
  if (source.Get(key, type, index, value) != AI_SUCCESS || !std::isfinite(value)) return otherwise;
  return value;
}

void addGltfOpacity(Material& material, const aiMaterial& source, float opacity) {
  aiString mode;
  if (source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS) return;
  material.opacity = held(opacity);
  if (std::string_view(mode.C_Str()) == "BLEND") material.solidity = Solidity::kClear;
  if (std::string_view(mode.C_Str()) != "MASK") return;
  material.solidity = Solidity::kCutOut;
  material.cutoff = held(numberOf(source, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5F));
}

void addOpacity(Material& material, const aiMaterial& source, const std::vector<devices::Image8>& pictures) {
  material.opacity = held(numberOf(source, AI_MATKEY_OPACITY, 1));
  // Some files mean the opposite; nobody makes a thing that cannot be seen at all.
  if (material.opacity <= 0) material.opacity = 1;
  if (material.opacity < 1) material.solidity = Solidity::kClear;
  if (material.picture < 0) return;
  const auto& picture = pictures[static_cast<std::size_t>(material.picture)];
  if (!letsSeeThrough(picture)) return;
  const bool cutOut = material.opacity >= 1 && isCutOut(picture);
  material.solidity = cutOut ? Solidity::kCutOut : Solidity::kClear;
}

/// A lamp on a surface of this roughness and metal, in Blinn's terms (Karis 2013). What is quite rough throws back as
/// much everywhere, which its colour shows already.
void addGltfShine(Material& material, const aiMaterial& source) {
  constexpr float kOfGlass = 0.04F;  // is thrown back, of light from the front
  const float metal = held(numberOf(source, AI_MATKEY_METALLIC_FACTOR, 1));
  const float rough = std::max(held(numberOf(source, AI_MATKEY_ROUGHNESS_FACTOR, 1)), 0.1F);
  const float exponent = 2 / std::pow(rough, 4.0F) - 2;
  material.shininess = std::max(exponent, 0.01F);
  material.shine = (1 - rough) * (exponent + 8) / 8 * glm::mix(glm::vec3(kOfGlass), material.colour, metal);
}

void addShine(Material& material, const aiMaterial& source, int shading) {
  aiColor4D colour(0, 0, 0, 1);
  const float exponent = numberOf(source, AI_MATKEY_SHININESS, 0);
  const bool shines = shading == aiShadingMode_Phong || shading == aiShadingMode_Blinn;
  if (!shines || exponent <= 1 || source.Get(AI_MATKEY_COLOR_SPECULAR, colour) != AI_SUCCESS) return;
  material.shine = lightOf(colour, false);
  material.shininess = std::min(exponent, 10'000.0F);
}

}  // namespace

Material materialOf(const aiMaterial& source, int picture, const std::vector<devices::Image8>& pictures, bool isGltf) {
  Material material;
  material.picture = picture;
  aiColor4D colour(0.8F, 0.8F, 0.8F, 1);
  const bool base = isGltf && source.Get(AI_MATKEY_BASE_COLOR, colour) == AI_SUCCESS;
  const bool given = base || source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS;
  // A picture is often given with a colour that nobody looked at: black.
  if (picture >= 0 && colour.r + colour.g + colour.b <= 0) colour = {1, 1, 1, colour.a};
  material.colour = lightOf(colour, isGltf || !given);
  aiColor4D emission(0, 0, 0, 1);
  if (source.Get(AI_MATKEY_COLOR_EMISSIVE, emission) == AI_SUCCESS) material.emission = lightOf(emission, isGltf);
  int shading = 0;
  if (source.Get(AI_MATKEY_SHADING_MODEL, shading) != AI_SUCCESS) shading = 0;
  material.lit = shading != aiShadingMode_Unlit;
  if (isGltf) {
    addGltfOpacity(material, source, colour.a);
    addGltfShine(material, source);
  } else {
    addOpacity(material, source, pictures);
    addShine(material, source, shading);
  }
  return material;
}

}  // namespace pixelflex::viewer
