#pragma once

#include <filesystem>
#include <string>

namespace pixelflex::viewer {

/// Whether a path, as a model's reader makes it, is an ordinary file of the model's folder or of one in it. What a
/// model names elsewhere is not opened.
[[nodiscard]] bool isOfModel(const std::filesystem::path& model, const std::filesystem::path& path);

/// Where a picture is that the model calls `name`: that place in the model's folder, or, where the name leads out of
/// it, as names of another machine do, the file of that name beside the model. Throws ImageError when neither is there.
[[nodiscard]] std::filesystem::path besideModel(const std::filesystem::path& model, const std::string& name);

}  // namespace pixelflex::viewer
