#pragma once

#include <filesystem>

#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// Refuses what need not be read to be known as damaged: an empty file, one that ends before what its header promises
/// (PLY, STL, GLB), one of more than kLargestModelFile bytes. Throws ModelError.
void checkModelFile(const std::filesystem::path& file);

inline constexpr std::uintmax_t kLargestModelFile = std::uintmax_t{16} << 30;

/// Reads one file in this process. The readers of the many formats are not ours and damaged files may end the process:
/// use loadScene(). Throws ModelError.
[[nodiscard]] Scene importScene(const std::filesystem::path& file);

}  // namespace pixelflex::viewer
