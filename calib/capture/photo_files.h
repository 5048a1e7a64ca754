#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pixelflex::calib {

/// The photographs directly in a folder, sorted; none when it is missing.
[[nodiscard]] std::vector<std::filesystem::path> photosIn(const std::filesystem::path& folder);

/// A photograph by its path without ending: .png, .jpg or .jpeg.
[[nodiscard]] std::optional<std::filesystem::path> findPhoto(const std::filesystem::path& withoutEnding);

/// Whether a folder holds the photographs of one projector, and not of a place of the camera: pictures and no folders
/// of pictures.
[[nodiscard]] bool isProjectorFolder(const std::filesystem::path& folder);

/// The subfolders that do, sorted; checkerboard/ is none.
[[nodiscard]] std::vector<std::filesystem::path> projectorFolders(const std::filesystem::path& folder);

/// The places of the camera under a folder: itself, unless it holds no projectors' folders but subfolders of it do;
/// those by name, numbers in them by value.
[[nodiscard]] std::vector<std::filesystem::path> placesIn(const std::filesystem::path& folder);

/// Changes when the file does.
[[nodiscard]] std::string stampOf(const std::filesystem::path& file);

}  // namespace pixelflex::calib
