#include "calib/simulate/raster_view.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace pixelflex::calib {

CameraView::CameraView(const SimulatedCameraSpec& camera, const Pose& place, const Screen& screen)
    : camera_(camera), screen_(screen), optics_(place, camera.optics) {}

std::optional<glm::dvec2> CameraView::wallFromRaster(glm::dvec2 pointInRaster) const {
  return optics_.wallFromPixel(screen_, pointInRaster);
}

std::optional<glm::dvec2> CameraView::rasterFromWall(glm::dvec2 pointInWall) const {
  return optics_.pixelFromWall(screen_, pointInWall);
}

double CameraView::transmission(glm::dvec2 pointInRaster) const {
  const glm::dvec2 half(0.5 * camera_.size.width, 0.5 * camera_.size.height);
  const glm::dvec2 off = pointInRaster - half;
  return std::max(0.0, 1 - camera_.vignetting * glm::dot(off, off) / glm::dot(half, half));
}

AudienceView::AudienceView(glm::dvec2 topLeft, glm::dvec2 bottomRight, devices::Size size)
    : topLeft_(topLeft), wallPerPixel_((bottomRight - topLeft) / glm::dvec2(size.width, size.height)), size_(size) {}

std::optional<glm::dvec2> AudienceView::wallFromRaster(glm::dvec2 pointInRaster) const {
  return topLeft_ + pointInRaster * wallPerPixel_;
}

std::optional<glm::dvec2> AudienceView::rasterFromWall(glm::dvec2 pointInWall) const {
  return (pointInWall - topLeft_) / wallPerPixel_;
}

}  // namespace pixelflex::calib
