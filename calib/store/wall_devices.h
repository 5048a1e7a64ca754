#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/store/wall.h"

namespace pixelflex::calib {

/// A controllable device of a wall.
struct WallDevice {
  std::string name;       // "p1.control", "p1.mirror"
  std::string projector;  // "p1"
  bool isMirror = false;
  DeviceLine line;  // paths no longer relative to the wall's folder
  bool operator==(const WallDevice&) const = default;
};

/// In the order of the projectors, each one's control before its mirror.
[[nodiscard]] std::vector<WallDevice> devicesOf(const Wall& wall, const std::filesystem::path& folder);

/// What the device's password file holds; empty without one. Throws StoreError when it cannot be read.
[[nodiscard]] std::string passwordOf(const WallDevice& device);

}  // namespace pixelflex::calib
