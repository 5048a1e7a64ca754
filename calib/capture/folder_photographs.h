#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"

namespace pixelflex::calib {

/// Photographs from folders, by the contract's rule: PROJECTOR/PATTERN.png or .jpg, fiducials.png, checkerboard/*.png,
/// camera.yaml. One folder per place of the camera; a single one whose subfolders follow the rule, but not itself,
/// holds as many places as those. Every error names the file.
class FolderPhotographs : public Photographs {
 public:
  /// `captures`: where keep() copies what was used; nothing is copied when the photographs lie there already. Throws
  /// CaptureError when a folder is missing.
  FolderPhotographs(const std::vector<std::filesystem::path>& folders, std::filesystem::path captures);

  [[nodiscard]] int placeCount() const override { return static_cast<int>(places_.size()); }
  void choosePlace(int place) override;
  [[nodiscard]] std::optional<CameraIntrinsics> knownCamera() override;
  [[nodiscard]] std::optional<Named> nextCheckerboard() override;
  [[nodiscard]] int checkerboardCount() const override { return static_cast<int>(checkerboards_.size()); }
  [[nodiscard]] std::string checkerboardPlace() const override;
  [[nodiscard]] std::optional<Method> methodTaken() override;
  [[nodiscard]] std::optional<BlobSize> blobSizeTaken(const std::string& projector) override;
  [[nodiscard]] bool hasFiducials() override;
  [[nodiscard]] Named fiducials() override;
  [[nodiscard]] bool hasProjector(const std::string& projector) override;
  [[nodiscard]] bool hasPattern(const std::string& projector, const ProjectedPattern& pattern) override;
  [[nodiscard]] devices::Image8 pattern(const std::string& projector, const ProjectedPattern& pattern) override;
  [[nodiscard]] std::vector<Exposed> exposures(const std::string& projector, const std::string& pattern) override;
  [[nodiscard]] bool hasExposures(const std::string& projector, const std::string& pattern) override;
  [[nodiscard]] std::string stamp(const std::string& kind) const override;
  void keep(Kept what) override;

 private:
  /// A photograph that was read, and its path in captures/ relative to its place.
  struct Used {
    std::filesystem::path file;
    int place = 0;
    std::filesystem::path relative;
  };
  [[nodiscard]] const std::filesystem::path& here() const { return places_[static_cast<std::size_t>(place_)]; }
  [[nodiscard]] devices::Image8 read(const std::filesystem::path& file, const std::filesystem::path& relative);
  [[nodiscard]] std::filesystem::path find(const std::filesystem::path& relativeWithoutEnding) const;
  [[nodiscard]] bool fromCaptures() const;

  std::vector<std::filesystem::path> places_;
  std::vector<std::filesystem::path> common_;  // folders that may hold checkerboard/ and camera.yaml, by precedence
  std::filesystem::path captures_;
  std::vector<Used> checkerboards_;
  std::size_t nextCheckerboard_ = 0;
  int place_ = 0;
  std::vector<Used> used_;
};

}  // namespace pixelflex::calib
