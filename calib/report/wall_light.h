#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib/photometric/predicted_view.h"
#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// All that the store holds of the light of the projectors that make one picture, in the calibration's order: of all of
/// them, or of the left eye's.
struct WallLight {
  std::vector<std::string> names;
  std::vector<PredictedProjector> projectors;
  std::vector<ProjectorMapping> mappings;
  bool matched = false;    // their colours and levels are made alike
  bool leakKnown = false;  // of all of them
  bool evened = false;     // black is lifted
  bool leftEye = false;    // a stack shows the other eye's picture to the other half

  [[nodiscard]] std::optional<std::size_t> indexOf(const std::string& name) const;
};

/// None where the display, or one projector's measured light or mask, is not there or cannot be read.
[[nodiscard]] std::optional<WallLight> readWallLight(const std::filesystem::path& folder, const Wall& wall,
                                                     const Calibration& calibration);

/// A projector's measured response; none where it was assumed, or its file cannot be read.
[[nodiscard]] std::optional<ResponseCurve> readStoredResponse(const std::filesystem::path& folder,
                                                              const ProjectorCalibration& projector);

/// A grey map of a projector; an empty one where there is none, or it cannot be read.
[[nodiscard]] devices::Image16 readStoredMap(const std::filesystem::path& folder,
                                             const std::optional<std::string>& name);

/// A measured white: three channels, `brightest` at 65535. Nodes that were not seen (0) take the mean of their
/// neighbours. None where nothing was seen.
[[nodiscard]] std::optional<devices::ImageF> whiteFromPicture(const devices::Image16& picture, double brightest);

}  // namespace pixelflex::calib
