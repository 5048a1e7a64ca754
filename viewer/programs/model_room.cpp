#include "viewer/programs/model_room.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pixelflex::viewer {
namespace {

RoomOfRig rigOf(const WallPlan& wall, const std::filesystem::path& folder, const std::vector<std::size_t>& projectors) {
  if (!wall.wall().rig) throw PlanError("a room needs a simulated wall: rig: FILE in wall.yaml");
  std::vector<std::string> names;
  for (const std::size_t i : projectors) names.push_back(wall.projectors().at(i)->name);
  return roomOfRig(folder / *wall.wall().rig, names);
}

}  // namespace

ModelRoom::ModelRoom(devices::GlContext& context, const WallPlan& wall, const std::filesystem::path& folder,
                     std::vector<std::size_t> projectors)
    : ModelRoom(context, rigOf(wall, folder, projectors), projectors) {}

ModelRoom::ModelRoom(devices::GlContext& context, const RoomOfRig& rig, std::vector<std::size_t> projectors)
    : projectors_(std::move(projectors)),
      framing_{.topLeft = rig.topLeft, .bottomRight = rig.bottomRight},
      room_(context, rig.projectors) {}

devices::Size ModelRoom::sizeFor(int width) const {
  const glm::dvec2 extent = framing_.bottomRight - framing_.topLeft;
  return {width, std::clamp(static_cast<int>(width * extent.y / extent.x), width / 7, width)};
}

void ModelRoom::draw(const ModelWall& model, devices::Size size) {
  framing_.picture = size;
  if (size.area() == 0) return;
  std::vector<devices::GlName> frames;
  for (const std::size_t i : projectors_) frames.push_back(model.texture(i));
  std::vector<std::size_t> all(projectors_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  room_.draw(frames, all, framing_);
}

}  // namespace pixelflex::viewer
