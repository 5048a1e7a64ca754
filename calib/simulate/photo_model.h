#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calib/simulate/light_map.h"
#include "calib/simulate/room_raster.h"
#include "calib/simulate/stage.h"
#include "devices/camera/operator.h"
#include "devices/image/image.h"

namespace pixelflex::calib {

/// What the rig's camera sees from one place, with everything that does not change from one photograph to the next
/// computed once.
class PhotoModel {
 public:
  /// Keeps a reference: the stage must outlive it.
  PhotoModel(const Stage& stage, const Pose& place);

  /// What a projector shows from now on; an empty image is black.
  void show(std::size_t projector, const devices::Image8& frame);
  /// `pose` counts the ways to hold the checkerboard. The exposure becomes the scene's own.
  void arrange(devices::Scene scene, int pose);
  /// Part of full scale that radiance 1 makes.
  [[nodiscard]] double exposure() const { return exposure_; }
  void setExposure(double exposure) { exposure_ = exposure; }
  /// `noiseSeed` decides the noise.
  [[nodiscard]] devices::Image8 shoot(std::uint64_t noiseSeed);

 private:
  [[nodiscard]] devices::ImageF leakOfAll() const;
  [[nodiscard]] devices::ImageF unlitWall(double roomLevel) const;
  void addBoard(devices::ImageF& radiance, int pose);
  void setExposures(const devices::ImageF& dark, const devices::ImageF& lit);
  void composeLight(std::size_t projector, const devices::Image8& frame);
  void addLight(devices::ImageF& radiance, const LightMap& map, const devices::ImageF& light) const;

  const Stage& stage_;
  CameraView view_;
  std::vector<float> kernel_;  // the point spread
  RoomRaster room_;
  std::vector<LightMap> maps_;
  std::vector<devices::ImageF> lights_;  // per projector: blurred radiance in its map's box; empty when black
  devices::ImageF leak_;
  devices::ImageF wall_;                       // radiance of the scene with all projectors black, blurred
  std::optional<devices::ImageF> boardCover_;  // while a checkerboard is held up
  double darkExposure_ = 1;
  double litExposure_ = 1;
  double exposure_ = 1;
};

}  // namespace pixelflex::calib
