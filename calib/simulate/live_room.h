#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "calib/simulate/projector_setting.h"
#include "calib/simulate/rig.h"
#include "calib/simulate/room_folder.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {

/// A simulated room that lives: its projectors show what programs publish in a folder (PublishedRoom), thrown as their
/// devices are set, and its camera sees that. In the same folder rig.yaml is the room as it is now. Thread-bound.
class LiveRoom {
 public:
  LiveRoom(Rig rig, std::filesystem::path folder);
  ~LiveRoom();
  LiveRoom(const LiveRoom&) = delete;
  LiveRoom& operator=(const LiveRoom&) = delete;

  [[nodiscard]] const Rig& rig() const { return rig_; }

  /// The room as it is from now on, one setting for each of the rig's projectors.
  void set(const std::vector<ProjectorSetting>& settings);

  /// What the camera sees now, exposed for so many seconds. The camera is the same however the projectors are set: more
  /// light makes a brighter picture. Throws std::runtime_error about the folder's files.
  [[nodiscard]] devices::Image8 photograph(double seconds);

 private:
  void rebuild();
  void show(std::size_t projector);
  void arrange();

  Rig rig_;
  std::filesystem::path folder_;
  RoomFolder published_;
  std::vector<ProjectorSetting> settings_;
  std::vector<devices::Image8> thrown_;  // what each projector shows; empty: black
  RoomScene arranged_;
  std::unique_ptr<SimulatedWall> wall_;  // as it is set
};

}  // namespace pixelflex::calib
