#include "tests/accuracy/report_light.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/geometry/projector_mapping.h"
#include "calib/store/readings_file.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

/// Where the pixels of one frame lie in another: smooth, so that nodes every 16 pixels and lines between will do.
class OtherFrame {
 public:
  OtherFrame(const ProjectorMapping& own, const ProjectorMapping& other)
      : columns_(own.resolution().width / kStep + 2), other_(other.resolution()) {
    const int rows = own.resolution().height / kStep + 2;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const auto inWall = own.wallFromProjector({column * kStep, row * kStep});
        const auto inOther = inWall ? other.projectorFromWall(*inWall) : std::nullopt;
        nodes_.push_back(inOther.value_or(glm::dvec2(-1e6)));
      }
    }
  }

  /// To the nearest edge of the other frame, in its pixels; 0 outside.
  [[nodiscard]] double distance(glm::dvec2 pointInOwn) const {
    const glm::dvec2 at = pointInOwn / double{kStep};
    const int column = static_cast<int>(at.x);
    const int row = static_cast<int>(at.y);
    const auto* node =
        &nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
    const glm::dvec2 part = at - glm::dvec2(column, row);
    const glm::dvec2 above = node[0] + part.x * (node[1] - node[0]);
    const glm::dvec2 below = node[columns_] + part.x * (node[columns_ + 1] - node[columns_]);
    const glm::dvec2 p = above + part.y * (below - above);
    return std::max(0.0, std::min(std::min(p.x, p.y), std::min(other_.width - p.x, other_.height - p.y)));
  }

 private:
  static constexpr int kStep = 16;
  int columns_;
  devices::Size other_;
  std::vector<glm::dvec2> nodes_;
};

Image8 maskOf(std::size_t own, const std::vector<ProjectorMapping>& mappings, double exponent) {
  std::vector<OtherFrame> frames;
  std::vector<double> priority;
  for (const auto& mapping : mappings) {
    frames.emplace_back(mappings[own], mapping);
    priority.push_back(std::pow(mapping.meanDensity() / mappings[own].meanDensity(), exponent));
  }
  Image8 mask(mappings[own].resolution(), 1);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      double sum = 0;
      for (std::size_t i = 0; i < frames.size(); ++i) sum += priority[i] * frames[i].distance({x + 0.5, y + 0.5});
      const double mine = frames[own].distance({x + 0.5, y + 0.5});
      mask.at(x, y) = static_cast<std::uint8_t>(std::lround(255 * mine / sum));
    }
  }
  return mask;
}

/// The code whose light above black was read nearest to each of 256 even steps.
std::array<std::uint8_t, 256> tableOf(const std::array<double, 256>& light) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t value = 0; value < table.size(); ++value) {
    const double wanted = light.front() + static_cast<double>(value) / 255 * (light.back() - light.front());
    const auto nearest = std::ranges::min_element(light, {}, [wanted](double read) { return std::abs(read - wanted); });
    table.at(value) = static_cast<std::uint8_t>(nearest - light.begin());
  }
  return table;
}

double lightOfSrgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace

std::vector<ReportLight> reportLight(const viewer::WallPlan& plan, const std::filesystem::path& folder) {
  std::vector<ProjectorMapping> mappings;
  for (const auto* projector : plan.projectors()) mappings.emplace_back(*projector);
  std::vector<ReportLight> all;
  for (std::size_t i = 0; i < mappings.size(); ++i) {
    const std::string file = (folder / "readings" / (plan.projectors()[i]->name + ".csv")).string();
    const Readings readings = readReadings(readStoreFile(file), file);
    if (!readings.problems.empty()) throw std::runtime_error(readings.problems.front().text());
    auto& light = all.emplace_back();
    light.mask = maskOf(i, mappings, plan.wall().blend.densityExponent);
    std::ranges::transform(readings.light, light.table.begin(), tableOf);
  }
  return all;
}

ImageF reportDesktop(const Image8& desktop) {
  std::array<float, 256> rounded{};
  for (std::size_t code = 0; code < 256; ++code) {
    rounded.at(code) = static_cast<float>(std::lround(255 * lightOfSrgb(static_cast<double>(code) / 255))) / 255;
  }
  ImageF light(desktop.size(), desktop.channels());
  std::ranges::transform(desktop.samples(), light.samples().begin(), [&](std::uint8_t code) { return rounded[code]; });
  return light;
}

Image8 reportFrame(const ImageF& warped, const ReportLight& light) {
  Image8 frame(warped.size(), 3);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = double{warped.at(x, y, c)} * light.mask.at(x, y);  // of 255
        const auto step = static_cast<std::size_t>(std::clamp(std::lround(value), 0L, 255L));
        frame.at(x, y, c) = light.table.at(static_cast<std::size_t>(c)).at(step);
      }
    }
  }
  return frame;
}

}  // namespace pixelflex::calib
