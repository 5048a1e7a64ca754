#pragma once

#include <algorithm>
#include <vector>

#include "viewer/model/scene.h"

struct aiMaterial;

namespace pixelflex::viewer {

/// `picture`: its number among `pictures`, -1 for none. glTF says colours in light, everything older in codes of a
/// screen, and glTF alone says how opacity is meant.
[[nodiscard]] Material materialOf(const aiMaterial& source, int picture, const std::vector<devices::Image8>& pictures,
                                  bool isGltf);

/// Within 0 and 1; what is not a number becomes 0.
[[nodiscard]] inline float held(float value) {
  return value >= 0 ? std::min(value, 1.0F) : 0.0F;
}

}  // namespace pixelflex::viewer
