#include "calib/simulate/live_room.h"

#include <cassert>
#include <utility>

#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

/// Whether the same picture would be thrown to the same place.
bool isThrownAlike(const ProjectorSetting& a, const ProjectorSetting& b) {
  return a.mirror == b.mirror && a.zoom == b.zoom && a.focus == b.focus && a.shift == b.shift && a.lit == b.lit;
}

}  // namespace

LiveRoom::LiveRoom(Rig rig, std::filesystem::path folder)
    : rig_(std::move(rig)),
      folder_(std::move(folder)),
      published_(folder_, rig_),
      settings_(rig_.projectors.size()),
      thrown_(rig_.projectors.size()) {
  rebuild();
}

LiveRoom::~LiveRoom() = default;

void LiveRoom::set(const std::vector<ProjectorSetting>& settings) {
  assert(settings.size() == settings_.size());
  if (settings == settings_) return;
  bool moved = false;
  std::vector<std::size_t> shownAnew;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    moved = moved || !isThrownAlike(settings[i], settings_[i]);
    if (settings[i] != settings_[i]) shownAnew.push_back(i);
  }
  settings_ = settings;
  if (moved) return rebuild();
  for (const std::size_t i : shownAnew) show(i);
}

void LiveRoom::rebuild() {
  Rig now = rig_;
  for (std::size_t i = 0; i < now.projectors.size(); ++i) now.projectors[i] = asSet(now.projectors[i], settings_[i]);
  devices::writeFileAtomically(folder_ / "rig.yaml", formatRig(now));
  wall_ = std::make_unique<SimulatedWall>(std::move(now), rig_);
  arranged_ = {};
  for (std::size_t i = 0; i < settings_.size(); ++i) show(i);
}

void LiveRoom::show(std::size_t projector) {
  devices::Image8& frame = thrown_[projector];
  if (!settings_[projector].frozen) frame = asSet(published_.frame(projector), settings_[projector]);
  if (frame.empty()) {
    wall_->projector(projector).blank();
  } else {
    wall_->projector(projector).show(frame);
  }
}

void LiveRoom::arrange() {
  const RoomScene& asked = published_.scene();
  if (asked.place != arranged_.place) (void)wall_->person().placeCamera(asked.place);
  if (asked != arranged_) (void)wall_->person().arrange(asked.scene, asked.index);
  arranged_ = asked;
}

devices::Image8 LiveRoom::photograph(double seconds) {
  for (const std::size_t changed : published_.look()) show(changed);
  arrange();
  (void)wall_->camera().exposureControl()->setExposure(seconds);
  return wall_->camera().shoot();
}

}  // namespace pixelflex::calib
