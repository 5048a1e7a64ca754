// The steps of Procedure that make the projectors' light one.
#include "calib/procedure/procedure.h"

#include <algorithm>
#include <utility>

#include "calib/photometric/response_curve.h"
#include "calib/procedure/light_step.h"
#include "calib/procedure/mask_step.h"
#include "calib/procedure/wording.h"
#include "calib/store/readings_file.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

/// Of white, as an instrument read it; negative when that cannot be told.
double leakOf(const std::filesystem::path& file) {
  const Readings readings = readReadings(readStoreFile(file.string()), file.string());
  double black = 0;
  double white = 0;
  for (const auto& channel : readings.light) {
    black += channel.front();
    white += channel.back();
  }
  return readings.problems.empty() && white > black ? black / (white - black) : -1;
}

}  // namespace

std::string Procedure::runBlend() {
  const auto masks = paintMasks(wall_.blend, calibration_.projectors, progress_);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    auto& projector = calibration_.projectors[i];
    projector.alpha = "calibration/" + projector.name + "-alpha.png";
    masks_[*projector.alpha] = masks[i];
  }
  return count(masks.size(), "mask");
}

std::string Procedure::runGamma() {
  std::size_t measured = 0;
  const auto byCamera = responsesByCamera();
  for (auto& projector : calibration_.projectors) {
    if (keepsResponse(projector.name)) {
      measured += projector.response ? 1 : 0;
      continue;
    }
    projector.response.reset();
    projector.responseError.reset();
    projector.leak.reset();
    if (options_.only.empty()) {
      projector.light.reset();
      projector.measured.reset();
    }
    const auto config = std::ranges::find(wall_.projectors, projector.name, &ProjectorConfig::name);
    if (config == wall_.projectors.end()) continue;
    if (const auto found = byCamera.find(projector.name); found != byCamera.end()) {
      projector.response = "calibration/" + projector.name + "-response.csv";
      projector.responseError = found->second.error;
      projector.leak = found->second.leak;
      responses_[*projector.response] = formatReadings(found->second.curve);
      ++measured;
    }
    const auto& gamma = config->gamma;
    if (!gamma) continue;
    const std::string file = (folder_ / *gamma).string();
    projector.response = "calibration/" + projector.name + "-response.csv";
    responses_[*projector.response] = formatReadings(withoutNoise(parseReadings(readStoreFile(file), file)));
    ++measured;
  }
  const std::size_t assumed = calibration_.projectors.size() - measured;
  const std::string error = byCamera.empty() ? "" : ", by camera to " + rounded(100 * typicalError(byCamera), 1) + " %";
  const std::string responses =
      count(measured, "response") + error + (assumed > 0 ? ", sRGB assumed for " + std::to_string(assumed) : "");
  return wall_.blend.matchesLight() && options_.only.empty() ? responses + ", " + matchProjectors() : responses;
}

std::map<std::string, MeasuredResponse> Procedure::responsesByCamera() {
  if (!measuresResponses()) return {};
  tookResponses_ = true;
  auto result =
      measureResponses(wall_, calibration_, options_.only, photographs("gamma"), progress_,
                       [this](const std::string& name, const std::string& problem) { reportFailure(name, problem); });
  if (result.camera) {
    camera_ = result.camera;
    calibration_.camera->response = "calibration/camera-response.csv";
    responses_[*calibration_.camera->response] = formatCameraResponse(*camera_);
  }
  return std::move(result.responses);
}

bool Procedure::measuresResponses() const {
  return std::ranges::any_of(wall_.projectors, [this](const ProjectorConfig& projector) {
    return projector.gammaByCamera && calibration_.find(projector.name) != nullptr &&
           (options_.only.empty() || options_.only.contains(projector.name));
  });
}

bool Procedure::keepsResponse(const std::string& projector) const {
  const auto config = std::ranges::find(wall_.projectors, projector, &ProjectorConfig::name);
  const bool byCamera = config != wall_.projectors.end() && config->gammaByCamera;
  return byCamera && !options_.only.empty() && !options_.only.contains(projector);
}

CameraResponse Procedure::knownCameraResponse() const {
  if (camera_) return *camera_;
  const auto& stored = calibration_.camera->response;
  return cameraResponse(wall_.camera, stored ? std::optional((folder_ / *stored).string()) : std::nullopt);
}

std::string Procedure::matchProjectors() {
  auto& source = photographs("gamma");
  std::vector<devices::Image16> masks;
  std::vector<double> leak;
  for (const auto& projector : calibration_.projectors) {
    const std::string path = projector.alpha.value_or("");
    const auto painted = masks_.find(path);
    masks.push_back(painted != masks_.end() ? painted->second : devices::readPng16(folder_ / path));
    const auto config = std::ranges::find(wall_.projectors, projector.name, &ProjectorConfig::name);
    const bool read = config != wall_.projectors.end() && config->gamma;
    leak.push_back(read ? leakOf(folder_ / *config->gamma) : projector.leak.value_or(-1));
  }
  const LightResult light =
      matchLight(wall_, calibration_, method_, masks, leak, knownCameraResponse(), source, progress_);
  for (auto& projector : calibration_.projectors) {
    projector.light = light.matches.at(projector.name);
    projector.measured = light.measured.at(projector.name);
  }
  masks_.insert(light.images.begin(), light.images.end());
  std::string text = "light matched at " + rounded(100 * light.kept, 0) + " % of it";
  if (light.contrastEven > 0) {
    text += ", black even: contrast " + rounded(light.contrastEven, 0) + " of " + rounded(light.contrastNative, 0);
  }
  return text;
}

}  // namespace pixelflex::calib
