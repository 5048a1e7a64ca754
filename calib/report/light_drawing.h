#pragma once

#include <string>
#include <vector>

#include "calib/photometric/response_curve.h"
#include "calib/report/overlap_profile.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// The light of each code, channel by channel, against that of sRGB. Light is drawn by its root of 2.2, so that dark
/// tones can be told apart and sRGB is nearly straight.
[[nodiscard]] std::string drawResponse(const ResponseCurve& response, const std::string& projector);

/// The power that a response is nearest to over the codes 20 to 235, mean of its channels.
[[nodiscard]] double gammaOf(const ResponseCurve& response);

/// Luminance of white across an overlap, uncorrected and corrected side by side: each projector's part in its colour
/// (`colours`, one a projector), the sum on top, the overlap shaded. `masked`: what the masks alone would give, dotted;
/// empty for none. `white` is the luminance that counts as 100 %.
struct ProfileDrawing {
  const OverlapLine& line;
  const Profile& before;
  const Profile& after;
  std::vector<double> masked;
  double white = 1;
  const std::vector<std::string>& colours;
};
[[nodiscard]] std::string drawProfiles(const ProfileDrawing& drawing, const std::string& label);

/// A map and between what bounds it lies, 0..1.
struct MapDrawing {
  std::string picture;  // black at the least, white at the most; empty for no map
  double least = 0, most = 0;
};
[[nodiscard]] MapDrawing drawStretched(const devices::Image16& map, const std::string& label);

}  // namespace pixelflex::calib
