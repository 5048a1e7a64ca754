#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "devices/image/image.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::calib {

/// What the report has for one projector: an alpha mask and a gamma correction table, both of eight bits.
struct ReportLight {
  devices::Image8 mask;
  std::array<std::array<std::uint8_t, 256>, 3> table{};  // device code for light 0 to 255, per channel
};

/// One for each of the plan's projectors. Equation 7 with the plan's exponent, the mean density, and for the distance
/// the smallest to one of the four edges in projector pixels. Throws std::runtime_error without sound readings.
[[nodiscard]] std::vector<ReportLight> reportLight(const viewer::WallPlan& plan, const std::filesystem::path& folder);

/// A desktop of sRGB codes as light rounded to 255 steps: four floats a pixel.
[[nodiscard]] devices::ImageF reportDesktop(const devices::Image8& desktop);

/// The codes that the projector gets for a warped picture of light.
[[nodiscard]] devices::Image8 reportFrame(const devices::ImageF& warped, const ReportLight& light);

}  // namespace pixelflex::calib
