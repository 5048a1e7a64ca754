#include "calib/programs/photograph_source.h"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

#include "calib/capture/exposure_meter.h"
#include "calib/capture/folder_photographs.h"
#include "calib/capture/live_photographs.h"
#include "calib/programs/live_wall.h"
#include "calib/simulate/simulated_wall.h"
#include "devices/camera/cameras.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

class FolderSource final : public PhotographSource {
 public:
  FolderSource(const std::vector<fs::path>& folders, const fs::path& captures) : photographs_(folders, captures) {}
  [[nodiscard]] Photographs& photographs() override { return photographs_; }
  [[nodiscard]] bool isLive() const override { return false; }

 private:
  FolderPhotographs photographs_;
};

class RoomSource final : public PhotographSource {
 public:
  RoomSource(const Rig& rig, const fs::path& captures)
      : room_(rig),
        photographs_(room_.camera(), projectorsOf(room_), room_.person(), captures, formatRig(rig),
                     rig.checkerboardPoses, room_.placeCount()) {}
  [[nodiscard]] Photographs& photographs() override { return photographs_; }
  [[nodiscard]] bool isLive() const override { return true; }

 private:
  static std::vector<devices::Projector*> projectorsOf(SimulatedWall& room) {
    std::vector<devices::Projector*> projectors;
    for (std::size_t i = 0; i < room.projectorCount(); ++i) projectors.push_back(&room.projector(i));
    return projectors;
  }
  SimulatedWall room_;
  LivePhotographs photographs_;
};

class CameraPhotographs final : public PhotographSource {
 public:
  CameraPhotographs(const fs::path& folder, const Wall& wall, const fs::path& captures)
      : wall_(openLiveWall(folder, wall)),
        camera_(devices::openCamera(wall.camera.source)),
        person_(wall_->person(), *camera_, wall_->projectors(), wall.camera.source),
        photographs_(*camera_, wall_->projectors(), person_, captures,
                     fmt::format("{} {}x{}", wall.camera.source, camera_->size().width, camera_->size().height),
                     wall_->checkerboardCount(), wall_->placeCount()) {}
  [[nodiscard]] Photographs& photographs() override { return photographs_; }
  [[nodiscard]] bool isLive() const override { return true; }

 private:
  std::unique_ptr<LiveWall> wall_;
  std::unique_ptr<devices::Camera> camera_;
  MeteredPerson person_;
  LivePhotographs photographs_;
};

}  // namespace

std::unique_ptr<PhotographSource> openSource(const fs::path& folder, const Wall& wall,
                                             const std::vector<std::string>& photos, bool keep) {
  const fs::path captures = folder / "captures";
  const fs::path kept = keep ? captures : fs::path();
  if (!photos.empty())
    return std::make_unique<FolderSource>(std::vector<fs::path>(photos.begin(), photos.end()), captures);
  const std::string& source = wall.camera.source;
  if (source == "sim") return std::make_unique<RoomSource>(loadRig(folder / *wall.rig), kept);
  if (source == "none") {
    throw std::runtime_error((folder / "wall.yaml").string() +
                             ": camera: source is none: photograph by hand and use --photos DIR (--patterns DIR tells "
                             "what to photograph)");
  }
  if (source != "photos") return std::make_unique<CameraPhotographs>(folder, wall, kept);
  if (fs::is_directory(captures)) return std::make_unique<FolderSource>(std::vector{captures}, captures);
  throw std::runtime_error(folder.string() +
                           ": camera: source is photos: give --photos DIR (--patterns DIR tells what to photograph)");
}

}  // namespace pixelflex::calib
