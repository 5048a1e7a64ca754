#include "viewer/panel/mirror_aim.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>

#include "calib/geometry/projector_mapping.h"
#include "calib/store/preset.h"
#include "calib/store/store.h"

namespace pixelflex::viewer {
namespace {

// Below so many counts a move says more about the backlash than about the mirror.
constexpr double kSmallestMove = 4;

std::optional<double> countsIn(const calib::PresetDevice& device, const std::string& setting) {
  for (const auto& [name, text] : device.settings) {
    double counts = 0;
    if (name != setting) continue;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), counts);
    if (error == std::errc()) return counts;
  }
  return std::nullopt;
}

void addPoses(const std::filesystem::path& folder, const calib::Preset& preset,
              std::map<std::string, std::vector<AimPose>>& poses) {
  if (!preset.calibration) return;
  const calib::Calibration calibration = calib::loadCalibration(folder / *preset.calibration);
  for (const auto& projector : calibration.projectors) {
    const auto mirror = std::ranges::find(preset.devices, projector.name + ".mirror", &calib::PresetDevice::name);
    if (mirror == preset.devices.end()) continue;
    const auto pan = countsIn(*mirror, "pan_counts");
    const auto tilt = countsIn(*mirror, "tilt_counts");
    if (pan && tilt) poses[projector.name].push_back({{*pan, *tilt}, centreInWall(projector)});
  }
}

/// Of a symmetric matrix.
glm::dvec2 eigenvalues(const glm::dmat2& matrix) {
  const double mean = 0.5 * (matrix[0][0] + matrix[1][1]);
  const double half = 0.5 * (matrix[0][0] - matrix[1][1]);
  const double radius = std::hypot(half, matrix[0][1]);
  return {mean - radius, mean + radius};
}

}  // namespace

glm::dvec2 MirrorAim::countsFor(glm::dvec2 byInWall) const {
  return glm::round(glm::inverse(wallFromCounts) * byInWall);
}

glm::dvec2 centreInWall(const calib::ProjectorCalibration& projector) {
  const calib::ProjectorMapping mapping(projector);
  const glm::dvec2 middle = {0.5 * projector.resolution.width, 0.5 * projector.resolution.height};
  return mapping.wallFromProjector(middle).value_or(glm::dvec2(0, 0));
}

MirrorAim aimByGeometry(const calib::ProjectorCalibration& projector, glm::dvec2 degreesPerCount) {
  const calib::ProjectorMapping mapping(projector);
  const glm::dvec2 middle = {0.5 * projector.resolution.width, 0.5 * projector.resolution.height};
  const double distance = projector.model.scale / mapping.density(middle);
  const glm::dvec2 beam = 2 * distance * std::numbers::pi / 180 * degreesPerCount;
  return {.wallFromCounts = {beam.x, 0, 0, -beam.y}, .measured = 0};
}

MirrorAim aimByPoses(const MirrorAim& geometry, std::span<const AimPose> poses) {
  if (poses.size() < 2) return geometry;
  AimPose mean;
  for (const auto& [counts, centre] : poses) {
    mean.counts += counts / static_cast<double>(poses.size());
    mean.centreInWall += centre / static_cast<double>(poses.size());
  }
  // Geometry weighs as much as one small move in each direction.
  constexpr double kWeight = kSmallestMove * kSmallestMove;
  glm::dmat2 moves(0);
  glm::dmat2 products = kWeight * geometry.wallFromCounts;
  for (const auto& [counts, centre] : poses) {
    moves += glm::outerProduct(counts - mean.counts, counts - mean.counts);
    products += glm::outerProduct(centre - mean.centreInWall, counts - mean.counts);
  }
  const glm::dvec2 told = eigenvalues(moves);
  constexpr double kTelling = 4 * kWeight;
  return {.wallFromCounts = products * glm::inverse(moves + glm::dmat2(kWeight)),
          .measured = (told.x > kTelling ? 1 : 0) + (told.y > kTelling ? 1 : 0)};
}

std::map<std::string, std::vector<AimPose>> posesOfPresets(const std::filesystem::path& folder) {
  std::map<std::string, std::vector<AimPose>> poses;
  for (const auto& name : calib::presetNames(folder)) {
    try {
      addPoses(folder, calib::loadPreset(folder, name), poses);
    } catch (const std::exception&) {
      continue;
    }
  }
  return poses;
}

}  // namespace pixelflex::viewer
