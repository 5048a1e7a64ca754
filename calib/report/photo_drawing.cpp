#include "calib/report/photo_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <set>
#include <string>
#include <vector>

#include "calib/capture/photo_files.h"
#include "calib/geometry/camera_mapping.h"
#include "calib/geometry/footprint.h"
#include "calib/geometry/screen_view.h"
#include "calib/report/html_text.h"
#include "calib/report/picture_uri.h"
#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

/// More samples than this are no blobs but a dense measurement.
constexpr std::size_t kMostBlobs = 150;
constexpr int kPhotoWidth = 640;

bool isDense(const ProjectorCalibration& projector) {
  return projector.quality.shown > static_cast<int>(kMostBlobs);
}

/// A photograph of the projector and the camera's place that it was taken from.
struct Shot {
  fs::path file;
  const SurfaceFit* surface = nullptr;
};

std::vector<Shot> shotsOf(const fs::path& folder, const SurfaceFit& first, const std::vector<SurfaceFit>& further,
                          const ProjectorCalibration& projector) {
  std::vector<std::pair<fs::path, const SurfaceFit*>> places = {{folder / "captures", &first},
                                                                {folder / "captures" / "place1", &first}};
  for (std::size_t i = 0; i < further.size(); ++i) {
    places.emplace_back(folder / "captures" / ("place" + std::to_string(i + 2)), &further[i]);
  }
  const bool dense = isDense(projector);
  const std::vector<std::string> names =
      dense ? std::vector<std::string>{"dense-white"} : std::vector<std::string>{"blobs", "blobs-fine", "blobs-coarse"};
  std::vector<Shot> shots;
  for (const auto& [place, surface] : places) {
    for (const auto& name : names) {
      if (const auto file = findPhoto(place / projector.name / name)) shots.push_back({*file, surface});
    }
  }
  return shots;
}

class PhotoDrawing {
 public:
  PhotoDrawing(const CameraIntrinsics& camera, const ProjectorCalibration& projector, const SurfaceFit& surface)
      : projector_(projector),
        mapping_(projector.model, projector.resolution),
        camera_(camera),
        view_(surface),
        size_(camera.size) {
    for (const auto& point : footprint(mapping_)) {
      const glm::dvec2 p = photoFromWall(point);
      border_.push_back(p);
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
  }

  /// Camera pixels of the projector that are in the picture.
  [[nodiscard]] double area() const {
    const PixelBox box = crop();
    return box.width() > 0 && box.height() > 0 ? double(box.width()) * box.height() : 0;
  }

  [[nodiscard]] std::string draw(const devices::Image8& photo) const {
    const PixelBox box = crop();
    const double unit = box.width() / 100.0;
    std::string svg = fmt::format(
        "<svg class=\"photo\" viewBox=\"{0} {1} {2} {3}\" role=\"img\" aria-label=\"{4} in the camera's photograph, "
        "{5} "
        "points found\">\n<image x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" href=\"{6}\"/>\n",
        box.left, box.top, box.width(), box.height(), escaped(projector_.name), projector_.samples.size(),
        photographUri(photo, box, kPhotoWidth));
    svg += "<polygon class=\"edge\" points=\"";
    for (const auto& point : border_) svg += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
    svg += fmt::format("\" stroke-width=\"{:.2f}\"/>\n", unit / 5);
    svg += isDense(projector_) ? drawDots(unit) : drawRings(unit);
    return svg + "</svg>\n";
  }

 private:
  [[nodiscard]] glm::dvec2 photoFromWall(glm::dvec2 pointInWall) const {
    return camera_.rawFromUndistorted(view_.imageFromWall(pointInWall));
  }

  [[nodiscard]] PixelBox crop() const {
    const glm::dvec2 margin = 0.05 * (high_ - low_);
    const glm::dvec2 edge(size_.width, size_.height);
    const glm::dvec2 low = glm::clamp(glm::floor(low_ - margin), glm::dvec2(0), edge);
    const glm::dvec2 high = glm::clamp(glm::ceil(high_ + margin), glm::dvec2(0), edge);
    return {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x), static_cast<int>(high.y)};
  }

  [[nodiscard]] std::string drawDots(double unit) const {
    std::string path;
    for (const auto& sample : projector_.samples) {
      const glm::dvec2 p = photoFromWall(sample.pointInWall);
      path += fmt::format("M{:.1f} {:.1f}h0", p.x, p.y);
    }
    return fmt::format("<path class=\"found dot\" d=\"{}\" stroke-width=\"{:.2f}\"/>\n", path, 0.6 * unit);
  }

  [[nodiscard]] std::string drawRings(double unit) const {
    std::string svg = fmt::format("<g class=\"found\" stroke-width=\"{:.2f}\">", unit / 3);
    for (const auto& sample : projector_.samples) {
      const glm::dvec2 p = photoFromWall(sample.pointInWall);
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>", p.x, p.y, 1.7 * unit);
    }
    std::string crosses;
    for (const auto& point : missingPoints()) {
      const auto inWall = mapping_.wallFromProjector(point);
      if (!inWall) continue;
      const glm::dvec2 p = photoFromWall(*inWall);
      crosses += fmt::format("M{0:.1f} {1:.1f}l{2:.1f} {2:.1f}m0 -{2:.1f}l-{2:.1f} {2:.1f}", p.x - 1.3 * unit,
                             p.y - 1.3 * unit, 2.6 * unit);
    }
    return svg + fmt::format("</g>\n<path class=\"missing\" d=\"{}\" stroke-width=\"{:.2f}\"/>\n", crosses, unit / 2);
  }

  /// Blobs stand in rows and columns: where a row and a column of those found meet, there was one.
  [[nodiscard]] std::vector<glm::dvec2> missingPoints() const {
    std::set<double> columns, rows;
    std::set<std::pair<double, double>> found;
    const auto rounded = [](double v) { return std::round(v * 16) / 16; };
    for (const auto& [point, inWall] : projector_.samples) {
      columns.insert(rounded(point.x));
      rows.insert(rounded(point.y));
      found.emplace(rounded(point.x), rounded(point.y));
    }
    std::vector<glm::dvec2> missing;
    if (columns.size() * rows.size() > kMostBlobs) return missing;
    for (const double y : rows) {
      for (const double x : columns) {
        if (!found.contains({x, y})) missing.emplace_back(x, y);
      }
    }
    return missing;
  }

  const ProjectorCalibration& projector_;
  ProjectorMapping mapping_;
  CameraMapping camera_;
  ScreenView view_;
  devices::Size size_;
  Outline border_;  // raw camera pixels
  glm::dvec2 low_{1e300};
  glm::dvec2 high_{-1e300};
};

}  // namespace

std::string drawPhotograph(const fs::path& folder, const Calibration& calibration,
                           const ProjectorCalibration& projector) {
  if (!calibration.camera || !calibration.surface || projector.samples.empty()) return "";
  std::string best;
  double largest = 0;
  for (const auto& shot : shotsOf(folder, *calibration.surface, calibration.places, projector)) {
    const PhotoDrawing drawing(*calibration.camera, projector, *shot.surface);
    if (drawing.area() <= largest) continue;
    try {
      const devices::Image8 photo = devices::readPhoto(shot.file);
      if (photo.size() != calibration.camera->size) continue;
      best = drawing.draw(photo);
      largest = drawing.area();
    } catch (const devices::ImageError&) {
      continue;  // a damaged photograph takes nothing from the figures
    }
  }
  return best;
}

}  // namespace pixelflex::calib
