#include "calib/capture/folder_photographs.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "calib/store/yaml_reader.h"
#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"

namespace pixelflex::calib {
namespace fs = std::filesystem;
namespace {

constexpr std::array kEndings = {".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"};

bool isPhoto(const fs::path& file) {
  return std::ranges::find(kEndings, file.extension().string()) != kEndings.end();
}

std::vector<fs::path> photosIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (entry.is_regular_file() && isPhoto(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::string stampOf(const fs::path& file) {
  std::error_code missing;
  const auto size = fs::file_size(file, missing);
  if (missing) return file.filename().string() + "-";
  const auto time = fs::last_write_time(file, missing).time_since_epoch().count();
  return file.filename().string() + " " + std::to_string(size) + " " + std::to_string(time) + "\n";
}

}  // namespace

FolderPhotographs::FolderPhotographs(fs::path folder, fs::path captures)
    : folder_(std::move(folder)), captures_(std::move(captures)) {
  if (!fs::is_directory(folder_)) {
    throw CaptureError(folder_.string() +
                       ": no such folder; `pixelflex calibrate WALL --patterns DIR` tells what to photograph");
  }
  checkerboards_ = photosIn(folder_ / "checkerboard");
}

std::optional<CameraIntrinsics> FolderPhotographs::knownCamera() {
  const fs::path file = folder_ / "camera.yaml";
  if (!fs::exists(file)) return std::nullopt;
  YamlReader reader(readStoreFile(file.string()), file.string());
  auto node = reader.root();
  if (const auto nested = node.optional("camera"); nested.defined()) node = nested;
  constexpr double kLargest = 1e6;
  CameraIntrinsics camera;
  const auto size = node.required("size").numbers(2, 16, 65536);
  const auto radial = node.required("radial").numbers(3, -1e3, 1e3);
  const auto tangential = node.required("tangential").numbers(2, -1e3, 1e3);
  camera.fx = node.required("fx").number(1, kLargest);
  camera.fy = node.required("fy").number(1, kLargest);
  camera.cx = node.required("cx").number(-kLargest, kLargest);
  camera.cy = node.required("cy").number(-kLargest, kLargest);
  reader.throwIfProblems();
  camera.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  std::copy_n(radial.begin(), 3, camera.radial.begin());
  std::copy_n(tangential.begin(), 2, camera.tangential.begin());
  used_.push_back(file);
  return camera;
}

std::optional<Photographs::Named> FolderPhotographs::nextCheckerboard() {
  if (nextCheckerboard_ >= checkerboards_.size()) return std::nullopt;
  const fs::path& file = checkerboards_[nextCheckerboard_++];
  return Named{file.string(), read(file)};
}

Photographs::Named FolderPhotographs::fiducials() {
  const fs::path file = find("fiducials");
  return {file.string(), read(file)};
}

bool FolderPhotographs::hasProjector(const std::string& projector) {
  return fs::is_directory(folder_ / projector);
}

devices::Image8 FolderPhotographs::pattern(const std::string& projector, const ProjectedPattern& pattern) {
  return read(find(patternPath(projector, pattern)));
}

std::string FolderPhotographs::stamp(const std::string& kind) const {
  std::string stamp;
  if (kind == "checkerboard") {
    for (const auto& file : checkerboards_) stamp += stampOf(file);
    return stamp + stampOf(folder_ / "camera.yaml");
  }
  if (kind == "fiducials") {
    for (const auto* ending : kEndings) stamp += stampOf(folder_ / (std::string("fiducials") + ending));
    return stamp;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (!entry.is_directory() || entry.path().filename() == "checkerboard") continue;
    const auto photos = photosIn(entry.path());
    files.insert(files.end(), photos.begin(), photos.end());
  }
  std::ranges::sort(files);
  for (const auto& file : files) stamp += file.parent_path().filename().string() + "/" + stampOf(file);
  return stamp;
}

void FolderPhotographs::keep() {
  if (fs::weakly_canonical(folder_) == fs::weakly_canonical(captures_)) return;
  for (const auto& file : used_) {
    const fs::path target = captures_ / file.lexically_relative(folder_);
    fs::create_directories(target.parent_path());
    fs::copy_file(file, target, fs::copy_options::overwrite_existing);
  }
}

devices::Image8 FolderPhotographs::read(const fs::path& file) {
  try {
    devices::Image8 photo = devices::readPhoto(file);
    used_.push_back(file);
    return photo;
  } catch (const devices::ImageError& error) {
    throw CaptureError(std::string(error.what()) + "; take this photograph again");
  }
}

fs::path FolderPhotographs::find(const fs::path& relativeWithoutEnding) const {
  for (const auto* ending : kEndings) {
    fs::path file = folder_ / (relativeWithoutEnding.string() + ending);
    if (fs::exists(file)) return file;
  }
  throw CaptureError((folder_ / relativeWithoutEnding).string() +
                     ".png (or .jpg): this photograph is missing; take it and run again");
}

}  // namespace pixelflex::calib
