#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"

namespace pixelflex::calib {

/// Photographs from a folder, by the contract's rule: PROJECTOR/PATTERN.png or .jpg, fiducials.png, checkerboard/*.png,
/// camera.yaml. Every error names the file.
class FolderPhotographs : public Photographs {
 public:
  /// `captures`: where keep() copies what was used; nothing is copied when it is the same folder. Throws CaptureError
  /// when there is no such folder.
  FolderPhotographs(std::filesystem::path folder, std::filesystem::path captures);

  [[nodiscard]] std::optional<CameraIntrinsics> knownCamera() override;
  [[nodiscard]] std::optional<Named> nextCheckerboard() override;
  [[nodiscard]] int checkerboardCount() const override { return static_cast<int>(checkerboards_.size()); }
  [[nodiscard]] Named fiducials() override;
  [[nodiscard]] bool hasProjector(const std::string& projector) override;
  [[nodiscard]] devices::Image8 pattern(const std::string& projector, const ProjectedPattern& pattern) override;
  [[nodiscard]] std::string stamp(const std::string& kind) const override;
  void keep() override;

 private:
  [[nodiscard]] devices::Image8 read(const std::filesystem::path& file);
  [[nodiscard]] std::filesystem::path find(const std::filesystem::path& relativeWithoutEnding) const;

  std::filesystem::path folder_;
  std::filesystem::path captures_;
  std::vector<std::filesystem::path> checkerboards_;
  std::size_t nextCheckerboard_ = 0;
  std::vector<std::filesystem::path> used_;
};

}  // namespace pixelflex::calib
