#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pixelflex::testing {

/// What something costs as something else grows.
struct Curve {
  std::string title;
  std::string across;                             // what grows
  std::vector<std::pair<double, double>> points;  // and seconds
};

/// An SVG picture with a frame for each curve, both axes logarithmic. Throws devices::ImageError.
void drawCurves(const std::vector<Curve>& curves, const std::filesystem::path& file);

}  // namespace pixelflex::testing
