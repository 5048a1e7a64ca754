#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "calib/store/wall.h"
#include "devices/camera/operator.h"
#include "devices/projector/projector.h"

namespace pixelflex::calib {

/// The projectors of a wall, and the person who arranges the room for photographs of it.
class LiveWall {
 public:
  LiveWall() = default;
  virtual ~LiveWall() = default;
  LiveWall(const LiveWall&) = delete;
  LiveWall& operator=(const LiveWall&) = delete;
  [[nodiscard]] virtual std::vector<devices::Projector*> projectors() = 0;
  [[nodiscard]] virtual devices::Operator& person() = 0;
  [[nodiscard]] virtual int placeCount() const { return 1; }
  /// Poses of the checkerboard, where that is known before; else 0.
  [[nodiscard]] virtual int checkerboardCount() const { return 0; }
};

/// Outputs that are all `sim`: the room that `pixelflex simulate --serve` photographs, by way of WALL/room. Others:
/// windows on this machine's outputs, and whoever sits at the terminal. Throws std::runtime_error.
[[nodiscard]] std::unique_ptr<LiveWall> openLiveWall(const std::filesystem::path& folder, const Wall& wall);

}  // namespace pixelflex::calib
