#include "calib/simulate/photo_model.h"

#include <algorithm>

#include "calib/simulate/blur.h"
#include "calib/simulate/board.h"
#include "calib/simulate/parallel.h"
#include "calib/simulate/sensor.h"

namespace pixelflex::calib {

namespace {

using devices::Image8;
using devices::ImageF;
using devices::Scene;

constexpr int kLatticeStep = 2;
constexpr double kBoardLight = 0.9;  // room light on the board in front of the wall

/// Mean of the light on white wall and the strongest light anywhere, first channel.
struct Levels {
  double white = 0;
  double strongest = 0;
};

Levels levelsOf(const ImageF& radiance, const ImageF& reflectance) {
  Levels levels;
  double count = 0;
  for (int y = 0; y < radiance.height(); ++y) {
    const auto light = radiance.row(y);
    const auto paint = reflectance.row(y);
    for (std::size_t x = 0; x < paint.size(); ++x) {
      const double here = *std::max_element(&light[3 * x], &light[3 * x] + 3);
      levels.strongest = std::max(levels.strongest, here);
      if (paint[x] < 0.9F) continue;
      levels.white += here;
      count += 1;
    }
  }
  levels.white = count > 0 ? levels.white / count : levels.strongest;
  return levels;
}

}  // namespace

PhotoModel::PhotoModel(const Stage& stage, const Pose& place)
    : stage_(stage),
      view_(stage.rig().camera, place, stage.screen()),
      kernel_(gaussianKernel(stage.rig().camera.blur * stage.rig().camera.blur)),
      room_(lookAtRoom(stage.rig(), view_)),
      lights_(stage.lights().size()) {
  for (const auto& light : stage_.lights()) maps_.emplace_back(view_, light, stage_.unit(), kLatticeStep);
  leak_ = leakOfAll();
  const ImageF lit = unlitWall(stage_.rig().room.lit);
  arrange(Scene::kDark, 0);
  setExposures(wall_, lit);
}

ImageF PhotoModel::leakOfAll() const {
  ImageF leak(view_.size(), 3);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const auto& spec = stage_.lights()[i].spec();
    ImageF black = maps_[i].render(LightImage(spec));
    for (std::size_t k = 0; k < black.samples().size(); ++k) {
      black.samples()[k] *= static_cast<float>(channelLight(spec.response, static_cast<int>(k % 3), 0));
    }
    addLight(leak, maps_[i], black);
  }
  return leak;
}

ImageF PhotoModel::unlitWall(double roomLevel) const {
  ImageF wall(view_.size(), 3);
  const auto level = static_cast<float>(roomLevel * stage_.typicalWhite());
  for (int y = 0; y < wall.height(); ++y) {
    const auto ambient = room_.ambient.row(y);
    const auto reflectance = room_.reflectance.row(y);
    const auto leak = leak_.row(y);
    const auto out = wall.row(y);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = level * ambient[i / 3] + reflectance[i / 3] * leak[i];
  }
  return wall;
}

void PhotoModel::setExposures(const ImageF& dark, const ImageF& lit) {
  // A camera that meets a wall without projectors, or a black room, still takes a picture: of darkness.
  constexpr double kFaint = 1e-6;
  double brightest = levelsOf(dark, room_.reflectance).strongest;
  const double ground = brightest;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    brightest = std::max(brightest, ground + maps_[i].brightest() * largestGain(stage_.lights()[i].spec().response));
  }
  darkExposure_ = 0.85 / std::max(kFaint, brightest);
  const Levels levels = levelsOf(lit, room_.reflectance);
  litExposure_ = std::min(0.75 / std::max(kFaint, levels.white), 0.95 / std::max(kFaint, levels.strongest));
  exposure_ = darkExposure_;  // the first scene is dark
}

void PhotoModel::arrange(Scene scene, int pose) {
  const Room& room = stage_.rig().room;
  wall_ = unlitWall(scene == Scene::kDark ? room.dark : room.lit);
  exposure_ = scene == Scene::kDark ? darkExposure_ : litExposure_;
  boardCover_.reset();
  if (scene == Scene::kCheckerboard) addBoard(wall_, pose);
  blur(wall_, kernel_);
}

void PhotoModel::addBoard(ImageF& radiance, int pose) {
  const auto& rig = stage_.rig();
  const BoardRaster board = drawBoard(rig.camera, rig.checkerboard, boardPose(rig.camera, rig.checkerboard, pose));
  const double level = kBoardLight * rig.room.lit * stage_.typicalWhite();
  for (int y = 0; y < radiance.height(); ++y) {
    for (int x = 0; x < radiance.width(); ++x) {
      const float cover = board.cover.at(x, y);
      if (cover == 0) continue;
      const auto light = static_cast<float>(level * view_.transmission({x + 0.5, y + 0.5}));
      for (int c = 0; c < 3; ++c) {
        float& here = radiance.at(x, y, c);
        here = here * (1 - cover) + board.reflectance.at(x, y) * light;
      }
    }
  }
  boardCover_ = board.cover;
}

void PhotoModel::show(std::size_t projector, const Image8& frame) {
  const bool black = std::ranges::all_of(frame.samples(), [](std::uint8_t code) { return code == 0; });
  if (black || maps_[projector].box().empty()) {
    lights_[projector] = {};
  } else {
    composeLight(projector, frame);
  }
}

void PhotoModel::composeLight(std::size_t projector, const Image8& frame) {
  const LightMap& map = maps_[projector];
  ImageF light = map.render(LightImage(stage_.lights()[projector].spec(), frame, LightImage::Leak::kWithout));
  for (int y = 0; y < light.height(); ++y) {
    const auto row = light.row(y);
    const auto reflectance = room_.reflectance.row(y + map.box().y0).subspan(static_cast<std::size_t>(map.box().x0));
    for (std::size_t i = 0; i < row.size(); ++i) row[i] *= reflectance[i / 3];
  }
  blur(light, kernel_);
  lights_[projector] = std::move(light);
}

void PhotoModel::addLight(ImageF& radiance, const LightMap& map, const ImageF& light) const {
  for (int y = 0; y < light.height(); ++y) {
    const auto from = light.row(y);
    const auto to = radiance.row(y + map.box().y0).subspan(3 * static_cast<std::size_t>(map.box().x0));
    for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
  }
}

Image8 PhotoModel::shoot(std::uint64_t noiseSeed) {
  ImageF radiance = wall_;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    if (!lights_[i].empty()) addLight(radiance, maps_[i], lights_[i]);
  }
  if (boardCover_) {  // the board hides the projectors' light too
    for (std::size_t i = 0; i < radiance.samples().size(); ++i) {
      radiance.samples()[i] += boardCover_->samples()[i / 3] * (wall_.samples()[i] - radiance.samples()[i]);
    }
  }
  return expose(stage_.rig().camera, radiance, exposure_, noiseSeed);
}

}  // namespace pixelflex::calib
