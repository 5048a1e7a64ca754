#include "calib/simulate/simulated_wall.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

#include "calib/simulate/audience.h"
#include "calib/simulate/photo_model.h"
#include "calib/simulate/stage.h"

namespace pixelflex::calib {

namespace {

using devices::Image8;
using devices::ImageF;
using devices::Scene;
using devices::Size;

constexpr double kSensitivity = 30;  // part of full scale that radiance 1 makes in a second
constexpr devices::ExposureRange kExposures{.shortest = 1e-4, .longest = 30};

std::string sizeText(Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void checkFrame(const SimulatedProjectorSpec& spec, const Image8& frame) {
  if (frame.size() != spec.resolution || (frame.channels() != 1 && frame.channels() != 3)) {
    throw std::invalid_argument("projector " + spec.name + ": a frame of " + sizeText(frame.size()) + " with " +
                                std::to_string(frame.channels()) + " channels was shown, but it needs " +
                                sizeText(spec.resolution) + " with one or three");
  }
}

std::vector<Pose> placesOf(const Rig& rig) {
  std::vector<Pose> places{rig.camera.pose};
  places.insert(places.end(), rig.cameraPlaces.begin(), rig.cameraPlaces.end());
  return places;
}

/// The camera's side of the wall, prepared at the first photograph: the audience's pictures do not need it.
class Studio {
 public:
  explicit Studio(const Stage& stage) : stage_(stage), places_(placesOf(stage.rig())), frames_(stage.lights().size()) {}

  void show(std::size_t index, Image8 frame) {
    frames_[index] = std::move(frame);
    if (model_) model_->show(index, frames_[index]);
  }

  [[nodiscard]] bool arrange(Scene scene, int index) {
    if (index < 0 || (scene == Scene::kCheckerboard && index >= stage_.rig().checkerboardPoses)) return false;
    scene_ = scene;
    pose_ = index;
    if (model_) model_->arrange(scene, index);
    return true;
  }

  [[nodiscard]] bool placeCamera(int place) {
    if (place < 0 || static_cast<std::size_t>(place) >= places_.size()) return false;
    if (place != place_) model_.reset();  // everything looks different from there
    place_ = place;
    return true;
  }

  [[nodiscard]] Image8 shoot() {
    prepare();
    ++photographs_;
    return model_->shoot((std::uint64_t{stage_.rig().seed} << 32U) + photographs_);
  }

  [[nodiscard]] double exposure() {
    prepare();
    return model_->exposure() / kSensitivity;
  }

  double setExposure(double seconds) {
    prepare();
    model_->setExposure(kSensitivity * std::clamp(seconds, kExposures.shortest, kExposures.longest));
    return exposure();
  }

 private:
  void prepare() {
    if (model_) return;
    model_ = std::make_unique<PhotoModel>(stage_, places_[static_cast<std::size_t>(place_)]);
    model_->arrange(scene_, pose_);
    for (std::size_t i = 0; i < frames_.size(); ++i) model_->show(i, frames_[i]);
  }

  const Stage& stage_;
  std::vector<Pose> places_;
  std::vector<Image8> frames_;
  int place_ = 0;
  Scene scene_ = Scene::kDark;
  int pose_ = 0;
  std::uint64_t photographs_ = 0;
  std::unique_ptr<PhotoModel> model_;
};

class StudioCamera final : public devices::Camera, public devices::ExposureControl {
 public:
  StudioCamera(Studio& studio, Size size) : studio_(studio), size_(size) {}
  [[nodiscard]] Size size() const override { return size_; }
  [[nodiscard]] Image8 shoot() override { return studio_.shoot(); }
  [[nodiscard]] devices::ExposureControl* exposureControl() override { return this; }
  [[nodiscard]] devices::ExposureRange exposureRange() const override { return kExposures; }
  [[nodiscard]] double exposure() override { return studio_.exposure(); }
  double setExposure(double seconds) override { return studio_.setExposure(seconds); }

 private:
  Studio& studio_;
  Size size_;
};

class StudioProjector final : public devices::Projector {
 public:
  StudioProjector(Studio& studio, std::size_t index, const SimulatedProjectorSpec& spec)
      : studio_(studio), index_(index), spec_(spec) {}
  [[nodiscard]] const std::string& name() const override { return spec_.name; }
  [[nodiscard]] Size resolution() const override { return spec_.resolution; }
  void show(const Image8& frame) override {
    checkFrame(spec_, frame);
    studio_.show(index_, frame);
  }
  void blank() override { studio_.show(index_, {}); }

 private:
  Studio& studio_;
  std::size_t index_;
  const SimulatedProjectorSpec& spec_;
};

class StudioPerson final : public devices::Operator {
 public:
  explicit StudioPerson(Studio& studio) : studio_(studio) {}
  [[nodiscard]] bool arrange(Scene scene, int index) override { return studio_.arrange(scene, index); }
  [[nodiscard]] bool placeCamera(int place) override { return studio_.placeCamera(place); }

 private:
  Studio& studio_;
};

}  // namespace

struct SimulatedWall::Impl {
  Impl(Rig rig, const Rig& reference)
      : stage(std::move(rig), reference), studio(stage), camera(studio, stage.rig().camera.size), person(studio) {
    for (const Pose& place : placesOf(stage.rig())) cameras.emplace_back(place, stage.rig().camera.optics);
    for (std::size_t i = 0; i < stage.lights().size(); ++i) {
      projectors.push_back(std::make_unique<StudioProjector>(studio, i, stage.rig().projectors[i]));
    }
  }

  Stage stage;
  std::vector<PlacedOptics> cameras;  // one a place
  Studio studio;
  StudioCamera camera;
  StudioPerson person;
  std::vector<std::unique_ptr<StudioProjector>> projectors;
  std::unique_ptr<AudienceLight> audience;  // of the last call
};

SimulatedWall::SimulatedWall(Rig rig, const Rig& reference)
    : impl_(std::make_unique<Impl>(std::move(rig), reference)) {}
SimulatedWall::~SimulatedWall() = default;

const Rig& SimulatedWall::rig() const {
  return impl_->stage.rig();
}
devices::Camera& SimulatedWall::camera() {
  return impl_->camera;
}
std::size_t SimulatedWall::projectorCount() const {
  return impl_->projectors.size();
}
devices::Projector& SimulatedWall::projector(std::size_t index) {
  return *impl_->projectors.at(index);
}
devices::Operator& SimulatedWall::person() {
  return impl_->person;
}
int SimulatedWall::placeCount() const {
  return static_cast<int>(impl_->cameras.size());
}

std::optional<glm::dvec2> SimulatedWall::wallFromProjector(std::size_t index, glm::dvec2 pointInProjector) const {
  return impl_->stage.lights().at(index).wallFromPixel(pointInProjector);
}

std::optional<glm::dvec2> SimulatedWall::projectorFromWall(std::size_t index, glm::dvec2 pointInWall) const {
  return impl_->stage.lights().at(index).pixelFromWall(pointInWall);
}

std::optional<glm::dvec2> SimulatedWall::cameraFromWall(glm::dvec2 pointInWall, int place) const {
  return impl_->cameras.at(static_cast<std::size_t>(place)).pixelFromWall(impl_->stage.screen(), pointInWall);
}

double SimulatedWall::light(std::size_t index, int channel, double code01) const {
  return channelLight(rig().projectors.at(index).response, channel, code01);
}

double SimulatedWall::radiance(std::size_t index, glm::dvec2 pointInProjector) const {
  const auto wall = wallFromProjector(index, pointInProjector);
  return wall ? impl_->stage.lights().at(index).illuminance(*wall) / impl_->stage.unit() : 0;
}

ImageF SimulatedWall::audienceLight(const std::vector<Image8>& frames, glm::dvec2 topLeft, glm::dvec2 bottomRight,
                                    Size size) const {
  for (std::size_t i = 0; i < frames.size() && i < projectorCount(); ++i) {
    if (!frames[i].empty()) checkFrame(rig().projectors[i], frames[i]);
  }
  auto& audience = impl_->audience;
  if (!audience || !audience->looksAt(topLeft, bottomRight, size)) {
    audience = std::make_unique<AudienceLight>(impl_->stage, topLeft, bottomRight, size);
  }
  return audience->of(frames);
}

Image8 SimulatedWall::audience(const std::vector<Image8>& frames, glm::dvec2 topLeft, glm::dvec2 bottomRight, Size size,
                               double white) const {
  const ImageF light = audienceLight(frames, topLeft, bottomRight, size);
  return developAudience(impl_->stage, light, topLeft, bottomRight, white);
}

}  // namespace pixelflex::calib
