#include "viewer/plan/model_wall.h"

#include <utility>

namespace pixelflex::viewer {

ModelWall::ModelWall(devices::GlContext& context, const WallPlan& wall, ModelWallOptions options)
    : context_(context), options_(std::move(options)), scene_(context, {}, options_.model) {
  setWall(wall);
}

void ModelWall::setWall(const WallPlan& wall) {
  auto arranged = arrangeModel(wall, options_);
  std::vector<std::unique_ptr<WallRenderer>> warps;
  for (auto& warp : arranged.warps) {
    warps.push_back(std::make_unique<WallRenderer>(context_, RendererOptions{.measure = options_.model.measure}));
    warps.back()->setPlans(warp.plans);
    warp.plans.clear();  // they are on the GPU now
  }
  scene_.setOutputs(arranged.outputs);
  arranged.outputs.clear();
  warps_ = std::move(warps);
  arranged_ = std::move(arranged);
  wall_ = &wall;
}

bool ModelWall::draw() {
  if (!scene_.needsDraw()) return false;
  scene_.draw();
  drawn_ = true;
  for (std::size_t i = 0; i < warps_.size(); ++i) {
    warps_[i]->copyDesktop(scene_.outputTexture(arranged_.warps[i].picture));
    warps_[i]->draw();
  }
  return true;
}

const std::string& ModelWall::name(std::size_t projector) const {
  return wall_->projectors().at(projector)->name;
}

devices::Size ModelWall::resolution(std::size_t projector) const {
  return wall_->projectors().at(projector)->resolution;
}

devices::GlName ModelWall::texture(std::size_t projector) const {
  const auto [warp, output] = arranged_.places.at(projector);
  return warps_.empty() ? scene_.outputTexture(output) : warps_[warp]->outputTexture(output);
}

devices::Image8 ModelWall::read(std::size_t projector) {
  const auto [warp, output] = arranged_.places.at(projector);
  return warps_.empty() ? scene_.readOutput(output) : warps_[warp]->readOutput(output);
}

devices::ImageF ModelWall::readFloat(std::size_t projector) {
  const auto [warp, output] = arranged_.places.at(projector);
  return warps_.empty() ? scene_.readOutputFloat(output) : warps_[warp]->readOutputFloat(output);
}

DrawnParts ModelWall::drawnParts(std::size_t projector) const {
  const auto [warp, output] = arranged_.places.at(projector);
  return scene_.drawnParts(warps_.empty() ? output : arranged_.warps[warp].picture);
}

devices::GlName ModelWall::desktopTexture(std::size_t eye) const {
  return scene_.outputTexture(arranged_.firstDesktop + eye);
}

}  // namespace pixelflex::viewer
