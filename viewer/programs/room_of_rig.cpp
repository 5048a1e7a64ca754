#include "viewer/programs/room_of_rig.h"

#include <algorithm>

#include "calib/simulate/simulated_wall.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {
namespace {

/// One mesh cell is about this many projector pixels: fine enough that straight lines inside it follow any lens.
constexpr int kCell = 32;

RoomMesh meshOf(const calib::SimulatedWall& room, std::size_t index) {
  RoomMesh mesh;
  mesh.resolution = room.rig().projectors[index].resolution;
  const int columns = std::max(1, mesh.resolution.width / kCell);
  const int rows = std::max(1, mesh.resolution.height / kCell);
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const glm::dvec2 p{double(column) * mesh.resolution.width / columns, double(row) * mesh.resolution.height / rows};
      const auto wall = room.wallFromProjector(index, p);
      if (!wall) throw PlanError("projector " + room.rig().projectors[index].name + ": its rays miss the screen");
      mesh.vertices.push_back({float(p.x), float(p.y), float(wall->x), float(wall->y), float(room.radiance(index, p))});
    }
  }
  const auto stride = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
    for (std::uint32_t column = 0; column + 1 < stride; ++column) {
      const std::uint32_t corner = row * stride + column;
      for (const std::uint32_t i :
           {corner, corner + 1, corner + stride, corner + 1, corner + stride + 1, corner + stride}) {
        mesh.indices.push_back(i);
      }
    }
  }
  for (int channel = 0; channel < 3; ++channel) {
    for (int code = 0; code < 256; ++code) {
      mesh.response[static_cast<std::size_t>(channel)].push_back(float(room.light(index, channel, code / 255.0)));
    }
  }
  return mesh;
}

}  // namespace

RoomOfRig roomOfRig(const std::filesystem::path& rigFile, const std::vector<std::string>& names) {
  const calib::SimulatedWall room(calib::loadRig(rigFile));
  RoomOfRig result{.topLeft = room.rig().screenTopLeft,
                   .bottomRight = room.rig().screenTopLeft + room.rig().screenSize};
  for (const auto& name : names) {
    const auto& all = room.rig().projectors;
    const auto found = std::ranges::find(all, name, &calib::SimulatedProjectorSpec::name);
    if (found == all.end()) throw PlanError(rigFile.string() + ": has no projector " + name);
    result.projectors.push_back(meshOf(room, static_cast<std::size_t>(found - all.begin())));
  }
  return result;
}

}  // namespace pixelflex::viewer
