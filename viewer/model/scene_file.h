#pragma once

#include <filesystem>
#include <span>

#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// Reads models: OBJ, PLY, STL, glTF and what else Assimp knows. Each file is read by a process of its own with limits
/// of memory and time, so that a damaged one ends in an error and nothing else. Throws ModelError.
[[nodiscard]] Scene loadScene(std::span<const std::filesystem::path> files);

}  // namespace pixelflex::viewer
