#include "viewer/model/model_folder.h"

#include <algorithm>
#include <system_error>

#include "devices/image/image_error.h"

namespace pixelflex::viewer {
namespace {

namespace fs = std::filesystem;

fs::path folderOf(const fs::path& model) {
  return fs::absolute(model).lexically_normal().parent_path();
}

/// By its name alone: a link in the folder may lead wherever its owner wants.
bool leadsOut(const fs::path& folder, const fs::path& path) {
  const fs::path way =
      fs::absolute(path).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  return way.empty() || *way.begin() == "..";
}

}  // namespace

bool isOfModel(const fs::path& model, const fs::path& path) {
  std::error_code error;
  return !leadsOut(folderOf(model), path) && fs::is_regular_file(path, error);
}

fs::path besideModel(const fs::path& model, const std::string& name) {
  std::string slashes = name;
  std::ranges::replace(slashes, '\\', '/');
  const fs::path folder = folderOf(model);
  for (const fs::path& place : {folder / slashes, folder / fs::path(slashes).filename()}) {
    if (isOfModel(model, place)) return place;
  }
  throw devices::ImageError("there is no such file in the model's folder");
}

}  // namespace pixelflex::viewer
