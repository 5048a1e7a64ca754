#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "calib/simulate/placed_optics.h"
#include "calib/simulate/rig.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// Something that looks at the screen and makes a raster of it.
class RasterView {
 public:
  RasterView() = default;
  virtual ~RasterView() = default;
  RasterView(const RasterView&) = delete;
  RasterView& operator=(const RasterView&) = delete;

  [[nodiscard]] virtual devices::Size size() const = 0;
  [[nodiscard]] virtual std::optional<glm::dvec2> wallFromRaster(glm::dvec2 pointInRaster) const = 0;
  [[nodiscard]] virtual std::optional<glm::dvec2> rasterFromWall(glm::dvec2 pointInWall) const = 0;
  /// Part of the light that reaches a raster point, 0..1.
  [[nodiscard]] virtual double transmission(glm::dvec2 pointInRaster) const = 0;
};

/// The camera at one place. Keeps references: specification and screen must outlive it.
class CameraView final : public RasterView {
 public:
  CameraView(const SimulatedCameraSpec& camera, const Pose& place, const Screen& screen);
  [[nodiscard]] const PlacedOptics& optics() const { return optics_; }
  [[nodiscard]] devices::Size size() const override { return camera_.size; }
  [[nodiscard]] std::optional<glm::dvec2> wallFromRaster(glm::dvec2 pointInRaster) const override;
  [[nodiscard]] std::optional<glm::dvec2> rasterFromWall(glm::dvec2 pointInWall) const override;
  [[nodiscard]] double transmission(glm::dvec2 pointInRaster) const override;

 private:
  const SimulatedCameraSpec& camera_;
  const Screen& screen_;
  PlacedOptics optics_;
};

/// Straight on, without a lens: a rectangle of the wall scaled to a raster.
class AudienceView final : public RasterView {
 public:
  AudienceView(glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size);
  [[nodiscard]] devices::Size size() const override { return size_; }
  [[nodiscard]] std::optional<glm::dvec2> wallFromRaster(glm::dvec2 pointInRaster) const override;
  [[nodiscard]] std::optional<glm::dvec2> rasterFromWall(glm::dvec2 pointInWall) const override;
  [[nodiscard]] double transmission(glm::dvec2 /*pointInRaster*/) const override { return 1; }

 private:
  glm::dvec2 topLeft_;
  glm::dvec2 wallPerPixel_;
  devices::Size size_;
};

}  // namespace pixelflex::calib
