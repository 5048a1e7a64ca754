#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "calib/photometric/mask.h"
#include "calib/report/report.h"
#include "calib/report/wall_light.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/plain_wall.h"

namespace pixelflex::calib {

/// A plain wall with everything that is known of light in its folder: the first projector twice as bright as the
/// others, the second short of blue.
class LitWall {
 public:
  explicit LitWall(int projectors = 2) : plain(projectors) {
    std::filesystem::create_directories(folder_ / "calibration");
    std::vector<ProjectorMapping> mappings;
    for (const auto& projector : plain.calibration.projectors) mappings.emplace_back(projector);
    const std::vector<double> densities(mappings.size(), 1.0);
    for (std::size_t i = 0; i < mappings.size(); ++i) {
      auto& projector = plain.calibration.projectors[i];
      projector.alpha = "calibration/" + projector.name + "-alpha.png";
      devices::writePng(folder_ / *projector.alpha, alphaMask(i, mappings, densities, MaskRules{}));
      writeWhite(i, {i == 0 ? 1.0 : 0.5, i == 0 ? 1.0 : 0.5, i == 0 ? 1.0 : i == 1 ? 0.4 : 0.5});
      projector.response = "calibration/" + projector.name + "-response.csv";
      std::ofstream(folder_ / *projector.response) << formatReadings(power(2.4));
    }
  }

  static ResponseCurve power(double exponent) {
    ResponseCurve curve;
    for (auto& channel : curve.light) {
      for (std::size_t code = 0; code < 256; ++code) channel.at(code) = std::pow(double(code) / 255, exponent);
    }
    return curve;
  }

  /// Levels and whites are made alike: 0.5 each, the blue of all as in the second.
  void match() {
    for (auto& projector : plain.calibration.projectors) {
      const bool first = projector.name == "p1";
      LightMatch match;
      match.colour = {1, 0, 0, 0, 1, 0, 0, 0, projector.name == "p2" ? 1 : 0.8};
      match.gain = "calibration/" + projector.name + "-gain.png";
      devices::Image16 gain({4, 4}, 1);
      for (auto& sample : gain.samples()) sample = first ? 32768 : 65535;
      devices::writePng(folder_ / *match.gain, gain);
      projector.light = match;
    }
  }

  void writeWhite(std::size_t projector, const std::array<double, 3>& level) {
    devices::Image16 white({8, 8}, 3);
    for (std::size_t i = 0; i < white.samples().size(); ++i) {
      white.samples()[i] = static_cast<std::uint16_t>(std::lround(65535 * level.at(i % 3)));
    }
    auto& own = plain.calibration.projectors[projector];
    own.measured = MeasuredLight{.white = "calibration/" + own.name + "-white.png", .brightest = 180, .leak = 0.002};
    devices::writePng(folder_ / own.measured.value().white, white);
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::string page() const {
    return reportHtml(folder(), plain.wall, plain.calibration, summarise(plain.wall, plain.calibration));
  }
  [[nodiscard]] std::optional<WallLight> light() const {
    return readWallLight(folder(), plain.wall, plain.calibration);
  }

  PlainWall plain;

 private:
  testing::TemporaryFolder folder_;
};

}  // namespace pixelflex::calib
