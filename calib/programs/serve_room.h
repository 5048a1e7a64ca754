#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calib/store/wall.h"
#include "calib/store/wall_devices.h"
#include "devices/serve/device_host.h"

namespace pixelflex::calib {

/// The room of a simulated wall, seen by a GigE Vision camera: its projectors show what is published in WALL/room
/// (PublishedRoom), thrown as their simulated devices in the host are set.
class ServedRoom {
 public:
  using Say = std::function<void(const std::string& line)>;

  /// The host must outlive this; of `devices` those in the host count, from how they are set now. `say` is called from
  /// any thread. Throws std::runtime_error.
  ServedRoom(const std::filesystem::path& folder, const Wall& wall, devices::DeviceHost& host,
             const std::vector<WallDevice>& devices, Say say);
  ~ServedRoom();
  ServedRoom(const ServedRoom&) = delete;
  ServedRoom& operator=(const ServedRoom&) = delete;

  /// What programs call the camera, and where it is.
  [[nodiscard]] std::string camera() const;
  /// Looks how the devices are set, so that WALL/room/rig.yaml is the room as it is. From any thread.
  void refresh();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the wall has a room, and a camera that is found on the network.
[[nodiscard]] bool hasServedCamera(const Wall& wall);

}  // namespace pixelflex::calib
