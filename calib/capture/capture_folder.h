#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "calib/capture/photographs.h"

namespace pixelflex::calib {

/// The wall's captures/: the photographs that the calibration in force was made from. New ones are gathered in a folder
/// beside it (captures.new/) and take their place only when commit() is called, so that nothing is lost before.
///
/// One place of the camera: PROJECTOR/PATTERN.png and fiducials.png. Several: the same under place1/, place2/ and so
/// on. checkerboard/ and camera.yaml are common to all places.
class CaptureFolder {
 public:
  /// Empties what an earlier attempt gathered, at the first file.
  CaptureFolder(std::filesystem::path captures, int placeCount);

  /// Where to put a file of a place (counted from 0) now, and where it will be afterwards; the path is relative to the
  /// place. The folder of the former exists.
  [[nodiscard]] std::filesystem::path gathered(int place, const std::filesystem::path& relative);
  [[nodiscard]] std::filesystem::path gathering() const { return gathering_; }

  /// Moves what was gathered into captures/, all or what belongs to the response. There, each folder that receives
  /// photographs keeps no others of their kind (the response's, or those of geometry), and places that the camera no
  /// longer stands at are dropped: an offline solve must not mix two sessions.
  void commit(Kept what = Kept::kAll);

 private:
  [[nodiscard]] std::filesystem::path inPlace(int place, const std::filesystem::path& relative) const;
  void moveFile(const std::filesystem::path& relative) const;
  void dropStale(const std::set<std::filesystem::path>& kept) const;
  void dropOtherPlaces() const;

  std::filesystem::path captures_;
  std::filesystem::path gathering_;
  int placeCount_;
  bool begun_ = false;
};

/// Whether a file belongs to the camera and not to a place that it stood at: checkerboard/ and camera.yaml.
[[nodiscard]] bool isCommon(const std::filesystem::path& relative);

}  // namespace pixelflex::calib
