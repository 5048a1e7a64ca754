#include "calib/capture/folder_photographs.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>

#include "calib/capture/capture_folder.h"
#include "calib/capture/exposure_name.h"
#include "calib/capture/photo_files.h"
#include "calib/patterns/response_pattern.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/exposure_time.h"
#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"

namespace pixelflex::calib {
namespace fs = std::filesystem;
namespace {

CameraIntrinsics readIntrinsics(const fs::path& file) {
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
  return camera;
}

bool liesIn(const fs::path& file, const fs::path& folder) {
  const fs::path relative = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

/// By their names, whatever their exposures.
std::vector<fs::path> photosOfPattern(const fs::path& folder, const std::string& pattern) {
  auto files = photosIn(folder);
  std::erase_if(files, [&](const fs::path& file) { return patternOfName(file.stem()) != pattern; });
  return files;
}

}  // namespace

FolderPhotographs::FolderPhotographs(const std::vector<fs::path>& folders, fs::path captures)
    : captures_(std::move(captures)) {
  assert(!folders.empty());
  for (const auto& folder : folders) {
    if (fs::is_directory(folder)) continue;
    throw CaptureError(folder.string() +
                       ": no such folder; `pixelflex calibrate WALL --patterns DIR` tells what to photograph");
  }
  places_ = folders.size() == 1 ? placesIn(folders.front()) : folders;
  common_ = folders;
  if (places_ != folders) common_.insert(common_.end(), places_.begin(), places_.end());
  for (std::size_t i = 0; i < common_.size(); ++i) {
    // The same name in two places is not the same photograph.
    const std::string prefix = i == 0 ? "" : std::to_string(i) + "-";
    for (const auto& file : photosIn(common_[i] / "checkerboard")) {
      checkerboards_.push_back({file, 0, "checkerboard" / fs::path(prefix + file.filename().string())});
    }
  }
}

void FolderPhotographs::choosePlace(int place) {
  assert(place >= 0 && place < placeCount());
  place_ = place;
}

std::optional<CameraIntrinsics> FolderPhotographs::knownCamera() {
  for (const auto& folder : common_) {
    const fs::path file = folder / "camera.yaml";
    if (!fs::exists(file)) continue;
    const CameraIntrinsics camera = readIntrinsics(file);
    used_.push_back({file, 0, "camera.yaml"});
    return camera;
  }
  return std::nullopt;
}

std::optional<Photographs::Named> FolderPhotographs::nextCheckerboard() {
  if (nextCheckerboard_ >= checkerboards_.size()) return std::nullopt;
  const Used& next = checkerboards_[nextCheckerboard_++];
  return Named{next.file.string(), read(next.file, next.relative)};
}

std::string FolderPhotographs::checkerboardPlace() const {
  std::string text;
  for (const auto& folder : common_) text += (text.empty() ? "" : ", ") + (folder / "checkerboard").string();
  return text + " (.png or .jpg)";
}

std::optional<Method> FolderPhotographs::methodTaken() {
  std::set<Method> taken;
  for (const auto& place : places_) {
    for (const auto& projector : projectorFolders(place)) {
      for (const Method method : {Method::kBlobs, Method::kDense}) {
        constexpr devices::Size kAny{64, 64};
        if (findPhoto(projector / patternsOf(method, kAny)[1].name)) taken.insert(method);
      }
    }
  }
  return taken.size() == 1 ? std::optional(*taken.begin()) : std::nullopt;
}

std::optional<BlobSize> FolderPhotographs::blobSizeTaken(const std::string& projector) {
  for (const BlobSize size : {BlobSize::kFine, BlobSize::kCoarse}) {
    const auto blobs = projected(Pattern::kBlobs, BlobLayout({64, 64}, size));
    if (findPhoto(here() / patternPath(projector, blobs))) return size;
  }
  return BlobSize::kUsual;
}

bool FolderPhotographs::hasFiducials() {
  return findPhoto(here() / "fiducials").has_value();
}

Photographs::Named FolderPhotographs::fiducials() {
  const fs::path file = find("fiducials");
  return {file.string(), read(file, file.filename())};
}

bool FolderPhotographs::hasProjector(const std::string& projector) {
  return fs::is_directory(here() / projector);
}

bool FolderPhotographs::hasPattern(const std::string& projector, const ProjectedPattern& pattern) {
  return findPhoto(here() / patternPath(projector, pattern)).has_value();
}

devices::Image8 FolderPhotographs::pattern(const std::string& projector, const ProjectedPattern& pattern) {
  const fs::path file = find(patternPath(projector, pattern));
  return read(file, projector / file.filename());
}

std::vector<Photographs::Exposed> FolderPhotographs::exposures(const std::string& projector,
                                                               const std::string& pattern) {
  std::vector<Exposed> photos;
  for (const auto& file : photosOfPattern(here() / projector, pattern)) {
    const auto told = exposureOfName(file.stem());
    const auto seconds = told ? told : devices::exposureTime(file);
    if (!seconds && file.stem() != pattern) {
      throw CaptureError(file.string() +
                         ": after the @ there must be the exposure in seconds: 0.5, or 1_60 for a sixtieth");
    }
    photos.push_back({file.string(), seconds, read(file, projector / file.filename())});
  }
  if (photos.empty()) (void)find(fs::path(projector) / pattern);  // says what is missing
  return photos;
}

bool FolderPhotographs::hasExposures(const std::string& projector, const std::string& pattern) {
  return !photosOfPattern(here() / projector, pattern).empty();
}

std::string FolderPhotographs::stamp(const std::string& kind) const {
  std::string stamp;
  if (kind == "checkerboard") {
    for (const auto& board : checkerboards_) stamp += stampOf(board.file);
    for (const auto& folder : common_) stamp += stampOf(folder / "camera.yaml");
    return stamp;
  }
  for (const auto& place : places_) {
    if (kind == "fiducials") {
      stamp += stampOf(findPhoto(place / "fiducials").value_or(place / "fiducials"));
      continue;
    }
    for (const auto& projector : projectorFolders(place)) {
      for (const auto& file : photosIn(projector)) {
        if (isOfResponse(file.stem()) != (kind == "response")) continue;
        stamp += projector.filename().string() + "/" + stampOf(file);
      }
    }
    stamp += "\n";
  }
  return stamp;
}

void FolderPhotographs::keep(Kept what) {
  if (fromCaptures()) return;
  CaptureFolder captures(captures_, placeCount());
  for (const auto& [file, place, relative] : used_) {
    const fs::path copy = captures.gathered(place, relative);
    fs::copy_file(file, copy, fs::copy_options::overwrite_existing);
    fs::last_write_time(copy, fs::last_write_time(file));  // the same photograph, so that nothing is stale
  }
  captures.commit(what);
}

bool FolderPhotographs::fromCaptures() const {
  return std::ranges::any_of(used_, [this](const Used& used) {
    return liesIn(used.file, captures_) || liesIn(used.file, CaptureFolder(captures_, 1).gathering());
  });
}

devices::Image8 FolderPhotographs::read(const fs::path& file, const fs::path& relative) {
  try {
    devices::Image8 photo = devices::readPhoto(file);
    used_.push_back({file, place_, relative});
    return photo;
  } catch (const devices::ImageError& error) {
    throw CaptureError(std::string(error.what()) + "; take this photograph again");
  }
}

fs::path FolderPhotographs::find(const fs::path& relativeWithoutEnding) const {
  if (const auto file = findPhoto(here() / relativeWithoutEnding)) return *file;
  throw CaptureError((here() / relativeWithoutEnding).string() +
                     ".png (or .jpg): this photograph is missing; take it and run again");
}

}  // namespace pixelflex::calib
