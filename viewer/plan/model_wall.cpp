#include "viewer/plan/model_wall.h"

#include <algorithm>
#include <stdexcept>

namespace pixelflex::viewer {

ModelWall::ModelWall(devices::GlContext& context, const WallPlan& wall, const std::filesystem::path& folder,
                     ModelWallOptions options)
    : wall_(wall), options_(options), eyes_(eyesOfProjectors(wall)) {
  for (const auto* projector : wall.projectors()) {
    fits_.push_back(fitOnePass(*projector, wall.display(), options_.features));
  }
  std::vector<ModelOutput> outputs;
  if (options_.passes == 1) {
    addProjectors(folder, outputs);
  } else {
    addCloseUps(outputs);
  }
  firstDesktop_ = outputs.size();
  if (options_.passes == 2 || options_.desktop) addDesktops(outputs);
  scene_ = std::make_unique<ModelRenderer>(context, outputs, options_.model);
  if (options_.passes == 2) makeWarps(context);
}

void ModelWall::addProjectors(const std::filesystem::path& folder, std::vector<ModelOutput>& outputs) {
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    ModelOutput output{.light = lightPlanOf(wall_, folder, i), .eye = eyes_[i]};
    try {
      output.projectorFromDesktop = depthKeeping(fits_[i].projectorFromDesktop);
    } catch (const std::invalid_argument& error) {
      throw PlanError("projector " + output.light.name + ": " + error.what() + "; show the model with --passes 2");
    }
    if (options_.lensAtVertices) output.lens = fits_[i].lens;
    places_.push_back({0, outputs.size()});
    outputs.push_back(std::move(output));
  }
}

void ModelWall::addCloseUps(std::vector<ModelOutput>& outputs) {
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    closeUps_.push_back(closeUpOf(wall_, i));
    if (!closeUps_[i]) continue;
    outputs.push_back(pictureFor(eyes_[i], closeUps_[i]->resolution));
    outputs.back().projectorFromDesktop = depthKeeping(partFromDesktop(*closeUps_[i], wall_.desktop()));
  }
}

void ModelWall::addDesktops(std::vector<ModelOutput>& outputs) {
  const bool middle = std::ranges::find(eyes_, Eye::kMiddle) != eyes_.end();
  const bool pairs = std::ranges::any_of(eyes_, [](Eye eye) { return eye != Eye::kMiddle; });
  if (pairs || options_.bothEyes) desktops_ = {Eye::kLeft, Eye::kRight};
  if (desktops_.empty() || (middle && options_.passes == 2)) desktops_.push_back(Eye::kMiddle);
  for (const Eye eye : desktops_) outputs.push_back(pictureFor(eye, wall_.desktop()));
}

/// As a desktop is: codes without any projector's light.
ModelOutput ModelWall::pictureFor(Eye eye, devices::Size resolution) const {
  ModelOutput output{.light = {.name = "desktop", .resolution = resolution, .desktop = resolution}, .eye = eye};
  output.light.dither = false;
  output.light.transfer =
      wall_.wall().transfer == calib::Transfer::kSrgb ? DesktopTransfer::kSrgb : DesktopTransfer::kLinear;
  return output;
}

void ModelWall::makeWarps(devices::GlContext& context) {
  auto plans = wall_.outputsFor(wall_.desktop());
  places_.resize(plans.size());
  for (std::size_t i = 0, picture = 0; i < plans.size(); ++i) {
    if (!closeUps_[i]) continue;
    places_[i] = {warps_.size(), 0};
    addWarp(context, picture++, {wall_.outputFor(i, displayOf(*closeUps_[i], wall_.display()))});
  }
  for (std::size_t desktop = 0; desktop < desktops_.size(); ++desktop) {
    std::vector<OutputPlan> own;
    for (std::size_t i = 0; i < plans.size(); ++i) {
      if (closeUps_[i] || eyes_[i] != desktops_[desktop]) continue;
      places_[i] = {warps_.size(), own.size()};
      own.push_back(std::move(plans[i]));
    }
    if (!own.empty()) addWarp(context, firstDesktop_ + desktop, own);
  }
}

void ModelWall::addWarp(devices::GlContext& context, std::size_t picture, const std::vector<OutputPlan>& plans) {
  auto renderer = std::make_unique<WallRenderer>(context, RendererOptions{.measure = options_.model.measure});
  renderer->setPlans(plans);
  warps_.push_back({picture, std::move(renderer)});
}

bool ModelWall::draw() {
  if (!scene_->needsDraw()) return false;
  scene_->draw();
  drawn_ = true;
  for (auto& warp : warps_) {
    warp.renderer->copyDesktop(scene_->outputTexture(warp.picture));
    warp.renderer->draw();
  }
  return true;
}

const std::string& ModelWall::name(std::size_t projector) const {
  return wall_.projectors().at(projector)->name;
}

devices::Size ModelWall::resolution(std::size_t projector) const {
  return wall_.projectors().at(projector)->resolution;
}

devices::GlName ModelWall::texture(std::size_t projector) const {
  const Place& place = places_.at(projector);
  return warps_.empty() ? scene_->outputTexture(place.output)
                        : warps_[place.renderer].renderer->outputTexture(place.output);
}

devices::Image8 ModelWall::read(std::size_t projector) {
  const Place& place = places_.at(projector);
  return warps_.empty() ? scene_->readOutput(place.output) : warps_[place.renderer].renderer->readOutput(place.output);
}

devices::ImageF ModelWall::readFloat(std::size_t projector) {
  const Place& place = places_.at(projector);
  return warps_.empty() ? scene_->readOutputFloat(place.output)
                        : warps_[place.renderer].renderer->readOutputFloat(place.output);
}

DrawnParts ModelWall::drawnParts(std::size_t projector) const {
  const Place& place = places_.at(projector);
  return scene_->drawnParts(warps_.empty() ? place.output : warps_[place.renderer].picture);
}

devices::GlName ModelWall::desktopTexture(std::size_t eye) const {
  return scene_->outputTexture(firstDesktop_ + eye);
}

}  // namespace pixelflex::viewer
