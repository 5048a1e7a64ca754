#include "calib/simulate/simulated_wall.h"

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
using devices::Scene;
using devices::Size;

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

/// The camera's side of the wall, prepared at the first photograph: the audience's pictures do not need it.
class Studio {
 public:
  explicit Studio(const Stage& stage) : stage_(stage), frames_(stage.lights().size()) {}

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

  [[nodiscard]] Image8 shoot() {
    if (!model_) prepare();
    ++photographs_;
    return model_->shoot((std::uint64_t{stage_.rig().seed} << 32U) + photographs_);
  }

 private:
  void prepare() {
    model_ = std::make_unique<PhotoModel>(stage_);
    model_->arrange(scene_, pose_);
    for (std::size_t i = 0; i < frames_.size(); ++i) model_->show(i, frames_[i]);
  }

  const Stage& stage_;
  std::vector<Image8> frames_;
  Scene scene_ = Scene::kDark;
  int pose_ = 0;
  std::uint64_t photographs_ = 0;
  std::unique_ptr<PhotoModel> model_;
};

class StudioCamera final : public devices::Camera {
 public:
  StudioCamera(Studio& studio, Size size) : studio_(studio), size_(size) {}
  [[nodiscard]] Size size() const override { return size_; }
  [[nodiscard]] Image8 shoot() override { return studio_.shoot(); }

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

 private:
  Studio& studio_;
};

}  // namespace

struct SimulatedWall::Impl {
  explicit Impl(Rig rig)
      : stage(std::move(rig)),
        view(stage.rig().camera, stage.screen()),
        studio(stage),
        camera(studio, stage.rig().camera.size),
        person(studio) {
    for (std::size_t i = 0; i < stage.lights().size(); ++i) {
      projectors.push_back(std::make_unique<StudioProjector>(studio, i, stage.rig().projectors[i]));
    }
  }

  Stage stage;
  CameraView view;
  Studio studio;
  StudioCamera camera;
  StudioPerson person;
  std::vector<std::unique_ptr<StudioProjector>> projectors;
};

SimulatedWall::SimulatedWall(Rig rig) : impl_(std::make_unique<Impl>(std::move(rig))) {}
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

std::optional<glm::dvec2> SimulatedWall::wallFromProjector(std::size_t index, glm::dvec2 pointInProjector) const {
  return impl_->stage.lights().at(index).wallFromPixel(pointInProjector);
}

std::optional<glm::dvec2> SimulatedWall::projectorFromWall(std::size_t index, glm::dvec2 pointInWall) const {
  return impl_->stage.lights().at(index).pixelFromWall(pointInWall);
}

std::optional<glm::dvec2> SimulatedWall::cameraFromWall(glm::dvec2 pointInWall) const {
  return impl_->view.rasterFromWall(pointInWall);
}

double SimulatedWall::light(std::size_t index, int channel, double code01) const {
  return channelLight(rig().projectors.at(index).response, channel, code01);
}

double SimulatedWall::radiance(std::size_t index, glm::dvec2 pointInProjector) const {
  const auto wall = wallFromProjector(index, pointInProjector);
  return wall ? impl_->stage.lights().at(index).illuminance(*wall) / impl_->stage.unit() : 0;
}

Image8 SimulatedWall::audience(const std::vector<Image8>& frames, glm::dvec2 topLeft, glm::dvec2 bottomRight, Size size,
                               double white) const {
  for (std::size_t i = 0; i < frames.size() && i < projectorCount(); ++i) {
    if (!frames[i].empty()) checkFrame(rig().projectors[i], frames[i]);
  }
  return composeAudience(impl_->stage, frames, topLeft, bottomRight, size, white);
}

}  // namespace pixelflex::calib
