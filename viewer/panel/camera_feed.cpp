#include "viewer/panel/camera_feed.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include "calib/estimate/fiducials.h"
#include "calib/simulate/simulated_wall.h"
#include "devices/camera/cameras.h"

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPause{200};
constexpr std::chrono::seconds kPauseAfterTrouble{3};
constexpr int kNice = 10;  // pictures may come later, the panel's window may not

/// Every n-th pixel, n as small as gives the width.
devices::Image8 reduced(const devices::Image8& photo, int mostWidth) {
  const int n = (photo.width() + mostWidth - 1) / mostWidth;
  if (n <= 1) return photo;
  devices::Image8 small({photo.width() / n, photo.height() / n}, photo.channels());
  for (int y = 0; y < small.height(); ++y) {
    for (int x = 0; x < small.width(); ++x) {
      for (int channel = 0; channel < photo.channels(); ++channel)
        small.at(x, y, channel) = photo.at(n * x, n * y, channel);
    }
  }
  return small;
}

}  // namespace

/// The camera with what belongs to it. The feed's thread.
class CameraFeed::Source {
 public:
  Source(const std::filesystem::path& folder, const calib::Wall& wall) {
    const std::string& source = wall.camera.source;
    if (source == "photos" || source == "none") {
      throw std::runtime_error("wall.yaml has camera: source: " + source + ", which gives no live picture.");
    }
    if (source != "sim") {
      real_ = devices::openCamera(source);
      return;
    }
    if (!wall.rig) throw std::runtime_error("camera: sim needs a rig: FILE as well in wall.yaml");
    room_ = std::make_unique<calib::SimulatedWall>(calib::loadRig(folder / *wall.rig));
    (void)room_->person().arrange(devices::Scene::kRoomLight, 0);
  }

  void show(const std::string& projector, const devices::Image8& frame) {
    for (std::size_t i = 0; room_ && i < room_->projectorCount(); ++i) {
      devices::Projector& each = room_->projector(i);
      if (each.name() == projector && each.resolution() == frame.size()) each.show(frame);
    }
  }
  [[nodiscard]] devices::Camera& camera() { return real_ ? *real_ : room_->camera(); }

 private:
  std::unique_ptr<devices::Camera> real_;
  std::unique_ptr<calib::SimulatedWall> room_;
};

CameraFeed::CameraFeed(std::filesystem::path folder, std::shared_ptr<const calib::Wall> wall)
    : folder_(std::move(folder)), wall_(std::move(wall)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void CameraFeed::want(bool wanted) {
  {
    const std::lock_guard lock(mutex_);
    if (wanted_ == wanted) return;
    wanted_ = wanted;
  }
  wake_.notify_all();
}

bool CameraFeed::isClosed() const {
  const std::lock_guard lock(mutex_);
  return !wanted_ && !open_;
}

std::shared_ptr<const CameraPicture> CameraFeed::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void CameraFeed::showInRoom(const std::string& projector, devices::Image8 frame) {
  const std::lock_guard lock(mutex_);
  frames_[projector] = std::make_shared<const devices::Image8>(std::move(frame));
}

void CameraFeed::run(const std::stop_token& stop) {
  (void)::setpriority(PRIO_PROCESS, 0, kNice);  // of this thread, on Linux, and of those that it starts
  std::unique_ptr<Source> source;
  std::uint64_t number = 0;
  while (waitUntilWanted(stop, source)) {
    std::shared_ptr<CameraPicture> picture;
    try {
      if (!source) source = std::make_unique<Source>(folder_, *wall_);
      picture = shoot(*source);
    } catch (const std::exception& error) {
      source.reset();
      picture = std::make_shared<CameraPicture>();
      picture->trouble = error.what();
    }
    picture->number = ++number;
    std::unique_lock lock(mutex_);
    latest_ = picture;
    const auto pause = picture->trouble.empty() ? std::chrono::milliseconds(kPause) : kPauseAfterTrouble;
    (void)wake_.wait_for(lock, stop, pause, [this] { return !wanted_; });
  }
}

/// False: it is over. Meanwhile others may have the camera.
bool CameraFeed::waitUntilWanted(const std::stop_token& stop, std::unique_ptr<Source>& source) {
  std::unique_lock lock(mutex_);
  if (!wanted_) {
    lock.unlock();
    source.reset();
    lock.lock();
    open_ = false;
  }
  if (!wake_.wait(lock, stop, [this] { return wanted_; }) || stop.stop_requested()) return false;
  open_ = true;
  return true;
}

std::shared_ptr<CameraPicture> CameraFeed::shoot(Source& source) {
  const auto frames = [this] {
    const std::lock_guard lock(mutex_);
    return frames_;
  }();
  for (const auto& [projector, frame] : frames) source.show(projector, *frame);
  auto picture = std::make_shared<CameraPicture>();
  const auto begun = Clock::now();
  const devices::Image8 photo = source.camera().shoot();
  picture->seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  picture->size = photo.size();
  picture->photo = reduced(photo, kMostWidth);
  picture->markers = calib::findMarkers(photo, calib::CameraMapping());
  return picture;
}

}  // namespace pixelflex::viewer
