#include "calib/capture/photo_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <utility>

namespace pixelflex::calib {
namespace fs = std::filesystem;
namespace {

constexpr std::array kEndings = {".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"};

std::vector<fs::path> subfoldersOf(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (entry.is_directory() && entry.path().filename() != "checkerboard") folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  return folders;
}

/// A key that sorts place10 after place9: the length of each number, in a letter, before its digits.
std::string naturalKey(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto isDigit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::string key;
  for (auto at = name.begin(); at != name.end();) {
    const auto end = std::find_if_not(at, name.end(), isDigit);
    if (end == at) {
      key += *at++;
    } else {
      key += static_cast<char>('0' + std::min<std::ptrdiff_t>(end - at, 9));
      key.append(at, end);
      at = end;
    }
  }
  return key;
}

}  // namespace

std::vector<fs::path> photosIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    const bool photo = std::ranges::find(kEndings, entry.path().extension().string()) != kEndings.end();
    if (photo && entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::optional<fs::path> findPhoto(const fs::path& withoutEnding) {
  for (const auto* ending : kEndings) {
    fs::path file = withoutEnding.string() + ending;
    if (fs::exists(file)) return file;
  }
  return std::nullopt;
}

bool isProjectorFolder(const fs::path& folder) {
  const auto hasPhotos = [](const fs::path& sub) { return !photosIn(sub).empty(); };
  const auto isPattern = [](const fs::path& photo) { return photo.stem() != "fiducials"; };
  return std::ranges::any_of(photosIn(folder), isPattern) && std::ranges::none_of(subfoldersOf(folder), hasPhotos);
}

std::vector<fs::path> projectorFolders(const fs::path& folder) {
  auto folders = subfoldersOf(folder);
  std::erase_if(folders, [](const fs::path& sub) { return !isProjectorFolder(sub); });
  return folders;
}

std::vector<fs::path> placesIn(const fs::path& folder) {
  if (!projectorFolders(folder).empty()) return {folder};
  auto places = subfoldersOf(folder);
  std::erase_if(places, [](const fs::path& sub) { return projectorFolders(sub).empty(); });
  std::ranges::sort(places, {}, naturalKey);
  return places.empty() ? std::vector{folder} : places;
}

std::string stampOf(const fs::path& file) {
  std::error_code missing;
  const auto size = fs::file_size(file, missing);
  if (missing) return file.filename().string() + "-";
  const auto time = fs::last_write_time(file, missing).time_since_epoch().count();
  return file.filename().string() + " " + std::to_string(size) + " " + std::to_string(time) + "\n";
}

}  // namespace pixelflex::calib
