#include "viewer/plan/model_arrangement.h"

#include <algorithm>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

class Arranging {
 public:
  Arranging(const WallPlan& wall, const ModelWallOptions& options)
      : wall_(wall), options_(options), eyes_(eyesOfProjectors(wall)) {}

  ModelArrangement run() {
    for (const auto* projector : wall_.projectors()) {
      result_.fits.push_back(fitOnePass(*projector, wall_.display(), options_.features));
    }
    if (options_.passes == 1) {
      addProjectors();
    } else {
      addCloseUps();
    }
    result_.firstDesktop = result_.outputs.size();
    if (options_.passes == 2 || options_.desktop) addDesktops();
    if (options_.passes == 2) addWarps();
    return std::move(result_);
  }

 private:
  void addProjectors() {
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      const auto& fit = result_.fits[i];
      ModelOutput output{.light = lightPlanOf(wall_, i), .eye = eyes_[i]};
      if (std::ranges::find(options_.inHardware, output.light.name) != options_.inHardware.end()) {
        output.light.inverseResponse = {};
        output.light.transfer = DesktopTransfer::kSrgb;
      }
      try {
        output.projectorFromDesktop = depthKeeping(fit.projectorFromDesktop);
      } catch (const std::invalid_argument& error) {
        throw PlanError("projector " + output.light.name + ": " + error.what() + "; show the model with --passes 2");
      }
      if (options_.lensAtVertices) output.lens = fit.lens;
      result_.places.push_back({0, result_.outputs.size()});
      result_.outputs.push_back(std::move(output));
    }
  }

  void addCloseUps() {
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      closeUps_.push_back(closeUpOf(wall_, i));
      if (!closeUps_[i]) continue;
      result_.outputs.push_back(pictureFor(eyes_[i], closeUps_[i]->resolution));
      result_.outputs.back().projectorFromDesktop = depthKeeping(partFromDesktop(*closeUps_[i], wall_.desktop()));
    }
  }

  void addDesktops() {
    const bool middle = std::ranges::find(eyes_, Eye::kMiddle) != eyes_.end();
    const bool pairs = std::ranges::any_of(eyes_, [](Eye eye) { return eye != Eye::kMiddle; });
    if (pairs || options_.bothEyes) desktops_ = {Eye::kLeft, Eye::kRight};
    if (desktops_.empty() || (middle && options_.passes == 2)) desktops_.push_back(Eye::kMiddle);
    for (const Eye eye : desktops_) result_.outputs.push_back(pictureFor(eye, wall_.desktop()));
  }

  /// As a desktop is: codes without any projector's light.
  [[nodiscard]] ModelOutput pictureFor(Eye eye, devices::Size resolution) const {
    ModelOutput output{.light = {.name = "desktop", .resolution = resolution, .desktop = resolution}, .eye = eye};
    output.light.dither = false;
    output.light.transfer =
        wall_.wall().transfer == calib::Transfer::kSrgb ? DesktopTransfer::kSrgb : DesktopTransfer::kLinear;
    return output;
  }

  void addWarps() {
    auto plans = wall_.outputsFor(wall_.desktop());
    result_.places.resize(plans.size());
    for (std::size_t i = 0, picture = 0; i < plans.size(); ++i) {
      if (!closeUps_[i]) continue;
      result_.places[i] = {result_.warps.size(), 0};
      result_.warps.push_back({picture++, {wall_.outputFor(i, displayOf(*closeUps_[i], wall_.display()))}});
    }
    for (std::size_t desktop = 0; desktop < desktops_.size(); ++desktop) {
      ModelArrangement::Warp warp{.picture = result_.firstDesktop + desktop};
      for (std::size_t i = 0; i < plans.size(); ++i) {
        if (closeUps_[i] || eyes_[i] != desktops_[desktop]) continue;
        result_.places[i] = {result_.warps.size(), warp.plans.size()};
        warp.plans.push_back(std::move(plans[i]));
      }
      if (!warp.plans.empty()) result_.warps.push_back(std::move(warp));
    }
  }

  const WallPlan& wall_;
  const ModelWallOptions& options_;
  std::vector<Eye> eyes_;                         // of each projector
  std::vector<std::optional<CloseUp>> closeUps_;  // likewise, of two passes
  std::vector<Eye> desktops_;
  ModelArrangement result_;
};

}  // namespace

ModelArrangement arrangeModel(const WallPlan& wall, const ModelWallOptions& options) {
  return Arranging(wall, options).run();
}

}  // namespace pixelflex::viewer
