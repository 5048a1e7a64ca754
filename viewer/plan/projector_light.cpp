#include "viewer/plan/projector_light.h"

#include <cstddef>
#include <optional>
#include <string>

#include "calib/photometric/response_curve.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/png_file.h"

namespace pixelflex::viewer {
namespace {

/// A grey picture; of `size` where one is given. An empty one when the calibration names none.
devices::Image16 readMap(const std::filesystem::path& folder, const std::optional<std::string>& name,
                         const std::optional<devices::Size>& size) {
  if (!name) return {};
  const auto file = folder / *name;
  const std::string cure = "; run pixelflex calibrate " + folder.string();
  if (!std::filesystem::exists(file)) throw PlanError(file.string() + ": the calibration needs this file" + cure);
  devices::Image16 map = devices::readPng16(file);
  if (map.channels() != 1) throw PlanError(file.string() + ": not a grey picture" + cure);
  if (size && map.size() != *size) {
    throw PlanError(file.string() + ": not a grey picture of the projector's resolution" + cure);
  }
  return map;
}

std::array<std::vector<float>, 3> readResponse(const std::filesystem::path& folder,
                                               const calib::ProjectorCalibration& projector) {
  if (!projector.response) return {};
  const std::string file = (folder / *projector.response).string();
  const auto curve = calib::parseReadings(calib::readStoreFile(file), file);
  std::array<std::vector<float>, 3> inverse;
  for (std::size_t c = 0; c < 3; ++c) inverse[c] = calib::inverseResponse(curve.light[c]);
  return inverse;
}

glm::mat3 matrixOf(const std::array<double, 9>& rowMajor) {
  glm::mat3 matrix;
  std::size_t next = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = static_cast<float>(rowMajor.at(next++));
  }
  return matrix;
}

}  // namespace

ProjectorLight readLight(const std::filesystem::path& folder, const calib::ProjectorCalibration& projector) {
  ProjectorLight light;
  light.inverseResponse = readResponse(folder, projector);
  if (projector.flatAt) return light;
  light.alpha = readMap(folder, projector.alpha, projector.resolution);
  if (!projector.light) return light;
  light.colour = matrixOf(projector.light->colour);
  light.gain = readMap(folder, projector.light->gain, std::nullopt);
  light.black = readMap(folder, projector.light->black, projector.resolution);
  for (int c = 0; c < 3; ++c) {
    light.largestBlack[c] = static_cast<float>(projector.light->largestBlack.at(static_cast<std::size_t>(c)));
  }
  return light;
}

}  // namespace pixelflex::viewer
