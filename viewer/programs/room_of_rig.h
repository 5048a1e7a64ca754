#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/simulate/rig.h"
#include "viewer/renderer/room_view.h"

namespace pixelflex::viewer {

/// A simulated wall as the room view needs it: optics turned into meshes and tables, once.
struct RoomOfRig {
  std::vector<RoomMesh> projectors;  // in the order of the names given
  glm::dvec2 topLeft{0, 0};          // the screen, wall units
  glm::dvec2 bottomRight{0, 0};
};

/// Throws PlanError for a projector that the rig does not have, StoreError for a bad rig.
[[nodiscard]] RoomOfRig roomOfRig(const std::filesystem::path& rigFile, const std::vector<std::string>& names);

}  // namespace pixelflex::viewer
