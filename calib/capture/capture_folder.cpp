#include "calib/capture/capture_folder.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "calib/capture/photo_files.h"
#include "calib/patterns/response_pattern.h"

namespace pixelflex::calib {
namespace fs = std::filesystem;
namespace {

const char* const kCheckerboard = "checkerboard";
const char* const kCamera = "camera.yaml";

std::string placeName(int place) {
  return "place" + std::to_string(place + 1);
}

std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  if (!fs::is_directory(folder)) return entries;
  for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
  return entries;
}

/// Whether this is place1/ and the like. A projector may be called so, too: its folder holds photographs itself.
bool isPlace(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name.starts_with("place") && name.size() > 5 && name.find_first_not_of("0123456789", 5) == std::string::npos &&
         !projectorFolders(folder).empty();
}

/// Whether this was seen from the one place that the camera stood at.
bool ofOnePlace(const fs::path& entry) {
  return isProjectorFolder(entry) || entry.stem() == "fiducials";
}

}  // namespace

bool isCommon(const fs::path& relative) {
  return !relative.empty() && (*relative.begin() == kCheckerboard || relative == kCamera);
}

CaptureFolder::CaptureFolder(fs::path captures, int placeCount)
    : captures_(std::move(captures)), gathering_(captures_.string() + ".new"), placeCount_(placeCount) {}

fs::path CaptureFolder::inPlace(int place, const fs::path& relative) const {
  return placeCount_ > 1 && !isCommon(relative) ? placeName(place) / relative : relative;
}

fs::path CaptureFolder::gathered(int place, const fs::path& relative) {
  if (!begun_) fs::remove_all(gathering_);
  begun_ = true;
  fs::path file = gathering_ / inPlace(place, relative);
  fs::create_directories(file.parent_path());
  return file;
}

void CaptureFolder::commit(Kept what) {
  if (!begun_) return;
  std::set<fs::path> kept;
  for (const auto& entry : fs::recursive_directory_iterator(gathering_)) {
    const bool wanted = what == Kept::kAll || isOfResponse(entry.path().stem());
    if (entry.is_regular_file() && wanted) kept.insert(entry.path().lexically_relative(gathering_));
  }
  for (const auto& file : kept) moveFile(file);
  dropStale(kept);
  if (what == Kept::kAll && !std::ranges::all_of(kept, isCommon)) dropOtherPlaces();
  fs::remove_all(gathering_);
  begun_ = false;
}

void CaptureFolder::moveFile(const fs::path& relative) const {
  fs::create_directories((captures_ / relative).parent_path());
  fs::rename(gathering_ / relative, captures_ / relative);
}

/// Photographs beside the new ones, of another method, another exposure or with another ending.
void CaptureFolder::dropStale(const std::set<fs::path>& kept) const {
  std::set<std::pair<fs::path, bool>> folders;  // and whether it is the response's photographs in it
  for (const auto& file : kept) {
    const fs::path folder = captures_ / file.parent_path();
    const bool ofPlace = file.stem() == "fiducials";  // its folder holds the projectors' folders
    if (!ofPlace && file != kCamera) folders.insert({folder, isOfResponse(file.stem())});
    for (const auto& other : entriesOf(folder)) {
      const bool stale = other.stem() == file.stem() && !kept.contains(other.lexically_relative(captures_));
      if (ofPlace && stale && fs::is_regular_file(other)) fs::remove(other);
    }
  }
  for (const auto& [folder, ofResponse] : folders) {
    for (const auto& other : entriesOf(folder)) {
      const bool stale =
          isOfResponse(other.stem()) == ofResponse && !kept.contains(other.lexically_relative(captures_));
      if (stale && fs::is_regular_file(other)) fs::remove(other);
    }
  }
  const bool newBoards = folders.contains({captures_ / kCheckerboard, false});
  if (newBoards && !kept.contains(kCamera)) fs::remove(captures_ / kCamera);
}

void CaptureFolder::dropOtherPlaces() const {
  std::set<fs::path> current;
  for (int i = 0; i < placeCount_ && placeCount_ > 1; ++i) current.insert(placeName(i));
  for (const auto& entry : entriesOf(captures_)) {
    if (isCommon(entry.filename()) || current.contains(entry.filename())) continue;
    if (isPlace(entry) || (placeCount_ > 1 && ofOnePlace(entry))) fs::remove_all(entry);
  }
}

}  // namespace pixelflex::calib
