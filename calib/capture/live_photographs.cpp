#include "calib/capture/live_photographs.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <exception>

#include "calib/capture/exposure_name.h"
#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

/// Black elsewhere: as large as the photograph, but a small file.
devices::Image8 onlyRegion(const devices::Image8& photo, const PictureRegion& region) {
  devices::Image8 part(photo.size(), photo.channels());
  const auto channels = static_cast<std::size_t>(photo.channels());
  const auto first = channels * static_cast<std::size_t>(std::clamp(region.left, 0, photo.width()));
  const auto last = channels * static_cast<std::size_t>(std::clamp(region.right, 0, photo.width()));
  for (int y = std::max(0, region.top); y < std::min(photo.height(), region.bottom) && first < last; ++y) {
    std::ranges::copy(photo.row(y).subspan(first, last - first),
                      part.row(y).begin() + static_cast<std::ptrdiff_t>(first));
  }
  return part;
}

}  // namespace

PhotoWriter::PhotoWriter() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

PhotoWriter::~PhotoWriter() = default;  // the thread is asked to stop and joined first: it is the last member

void PhotoWriter::write(std::filesystem::path file, devices::Image8 photo) {
  constexpr std::size_t kLongestQueue = 4;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return queue_.size() < kLongestQueue || error_; });
  if (error_) std::rethrow_exception(error_);
  queue_.emplace_back(std::move(file), std::move(photo));
  changed_.notify_all();
}

void PhotoWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return (queue_.empty() && !writing_) || error_; });
  if (error_) std::rethrow_exception(error_);
}

void PhotoWriter::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !queue_.empty(); })) {
    const auto [file, photo] = std::move(queue_.front());
    queue_.pop_front();
    writing_ = true;
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr error;
    try {
      devices::writePng(file, photo);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    writing_ = false;
    if (error) error_ = error;
    changed_.notify_all();
    if (error_) return;
  }
}

LivePhotographs::LivePhotographs(devices::Camera& camera, std::vector<devices::Projector*> projectors,
                                 devices::Operator& person, std::filesystem::path captures, std::string identity,
                                 int checkerboardCount, int placeCount)
    : camera_(camera),
      projectors_(std::move(projectors)),
      person_(person),
      identity_(std::move(identity)),
      checkerboardCount_(checkerboardCount),
      placeCount_(placeCount) {
  if (!captures.empty()) captures_.emplace(std::move(captures), placeCount);
}

LivePhotographs::~LivePhotographs() {
  try {
    blankAll();
  } catch (const std::exception&) {  // a projector that is gone cannot be blanked; nothing is left to do for it
  }
}

void LivePhotographs::choosePlace(int place) {
  assert(place >= 0 && place < placeCount_);
  if (place == place_) return;
  blankAll();
  if (!person_.placeCamera(place)) {
    throw CaptureError("the camera could not be put at its place " + std::to_string(place + 1) + " of " +
                       std::to_string(placeCount_));
  }
  place_ = place;
}

std::optional<Photographs::Named> LivePhotographs::nextCheckerboard() {
  if (nextCheckerboard_ == 0) blankAll();
  dark_ = false;
  if (!person_.arrange(devices::Scene::kCheckerboard, nextCheckerboard_)) return std::nullopt;
  return shoot("checkerboard/" + std::to_string(++nextCheckerboard_) + ".png");
}

Photographs::Named LivePhotographs::fiducials() {
  blankAll();
  dark_ = false;
  if (!person_.arrange(devices::Scene::kRoomLight, 0)) throw CaptureError("the room lights could not be switched on");
  return shoot("fiducials.png");
}

devices::Image8 LivePhotographs::pattern(const std::string& projector, const ProjectedPattern& pattern) {
  const std::filesystem::path relative = patternPath(projector, pattern).string() + ".png";
  if (const auto taken = taken_.find({place_, relative}); taken != taken_.end()) return readAgain(taken->second);
  showInTheDark(projector, pattern);
  expose(std::nullopt);
  Named shot = shoot(relative);
  if (captures_) taken_[{place_, relative}] = shot.name;
  return std::move(shot.photo);
}

void LivePhotographs::showInTheDark(const std::string& projector, const ProjectedPattern& pattern) {
  devices::Projector* target = find(projector);
  if (target == nullptr) throw CaptureError("projector " + projector + " is not connected");
  darken();
  if (lit_ == target && shown_ == pattern.name) return;
  if (lit_ != target) blankAll();
  target->show(pattern.render());
  lit_ = target;
  shown_ = pattern.name;
}

void LivePhotographs::darken() {
  if (dark_) return;
  if (!person_.arrange(devices::Scene::kDark, 0)) throw CaptureError("the room could not be darkened");
  dark_ = true;
}

std::optional<devices::ExposureRange> LivePhotographs::exposureRange() {
  const auto* control = camera_.exposureControl();
  return control != nullptr ? std::optional(control->exposureRange()) : std::nullopt;
}

double LivePhotographs::usualExposure() {
  assert(camera_.exposureControl() != nullptr);
  darken();
  return usual_ ? *usual_ : camera_.exposureControl()->exposure();
}

/// None asks for the usual one of the scene.
void LivePhotographs::expose(std::optional<double> seconds) {
  if (!seconds && !usual_) return;
  auto& control = *camera_.exposureControl();
  if (!usual_) usual_ = control.exposure();
  control.setExposure(seconds.value_or(*usual_));
  if (!seconds) usual_.reset();
}

Photographs::Exposed LivePhotographs::exposed(const std::string& projector, const ProjectedPattern& pattern,
                                              double seconds, const PictureRegion& region) {
  assert(camera_.exposureControl() != nullptr);
  showInTheDark(projector, pattern);
  expose(seconds);
  const double actual = camera_.exposureControl()->exposure();
  devices::Image8 photo = camera_.shoot();
  const std::string name = nameWithExposure(patternPath(projector, pattern).string(), actual) + ".png";
  if (!captures_) return {name, actual, std::move(photo)};
  const std::filesystem::path file = captures_->gathered(place_, name);
  writer_.write(file, onlyRegion(photo, region));
  return {file.string(), actual, std::move(photo)};
}

devices::Image8 LivePhotographs::readAgain(const std::filesystem::path& file) {
  writer_.finish();
  try {
    return devices::readPhoto(file);
  } catch (const devices::ImageError& error) {
    throw CaptureError(error.what());
  }
}

std::string LivePhotographs::stamp(const std::string& kind) const {
  return placeCount_ > 1 && kind != "checkerboard" ? identity_ + "\nplaces " + std::to_string(placeCount_) : identity_;
}

void LivePhotographs::keep(Kept what) {
  writer_.finish();
  if (captures_) captures_->commit(what);
}

devices::Projector* LivePhotographs::find(const std::string& name) const {
  for (devices::Projector* projector : projectors_) {
    if (projector->name() == name) return projector;
  }
  return nullptr;
}

void LivePhotographs::blankAll() {
  expose(std::nullopt);
  lit_ = nullptr;
  for (devices::Projector* projector : projectors_) projector->blank();
}

Photographs::Named LivePhotographs::shoot(const std::filesystem::path& relative) {
  devices::Image8 photo = camera_.shoot();
  if (!captures_) return {relative.string(), std::move(photo)};
  const std::filesystem::path file = captures_->gathered(place_, relative);
  writer_.write(file, photo);
  return {file.string(), std::move(photo)};
}

}  // namespace pixelflex::calib
