#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calib/simulate/rig.h"
#include "devices/camera/operator.h"
#include "devices/image/image.h"
#include "devices/projector/projector.h"

namespace pixelflex::calib {

/// How the room is arranged for a photograph, and where the camera stands.
struct RoomScene {
  devices::Scene scene = devices::Scene::kDark;
  int index = 0;
  int place = 0;
  bool operator==(const RoomScene&) const = default;
};

/// A simulated room for programs that do not hold it themselves: what its projectors show and how it is arranged go
/// through a folder, NAME.png for each projector that is not black and room.txt, each replaced in one step. Who
/// photographs the room (`pixelflex simulate --serve`) looks there before every photograph, so a picture is on the wall
/// when show() returns.
class PublishedRoom {
 public:
  /// The rig tells names, resolutions, and what there is to arrange. Everything is black at first and at the end.
  PublishedRoom(std::filesystem::path folder, const Rig& rig);
  ~PublishedRoom();
  PublishedRoom(const PublishedRoom&) = delete;
  PublishedRoom& operator=(const PublishedRoom&) = delete;

  /// They live as long as this.
  [[nodiscard]] std::vector<devices::Projector*> projectors() const;
  [[nodiscard]] devices::Operator& person() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The other side of a PublishedRoom.
class RoomFolder {
 public:
  RoomFolder(std::filesystem::path folder, const Rig& rig);

  /// What has changed since the last call: the indices of projectors. Throws std::runtime_error when a file is no
  /// picture of its projector's resolution.
  [[nodiscard]] std::vector<std::size_t> look();
  /// Empty: black. As of the last look().
  [[nodiscard]] const devices::Image8& frame(std::size_t projector) const { return shown_.at(projector).frame; }
  [[nodiscard]] const RoomScene& scene() const { return scene_; }

 private:
  struct Shown {
    std::string name;
    devices::Size resolution;
    std::string bytes;  // of the file
    devices::Image8 frame;
  };
  std::filesystem::path folder_;
  std::vector<Shown> shown_;
  RoomScene scene_;
};

}  // namespace pixelflex::calib
