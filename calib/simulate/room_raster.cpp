#include "calib/simulate/room_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

#include "calib/simulate/aruco_4x4.h"
#include "calib/simulate/parallel.h"

namespace pixelflex::calib {

namespace {

constexpr double kPaper = 0.95;
constexpr double kInk = 0.05;
constexpr double kSurround = 0.06;
constexpr double kQuietZone = 1.0 / 6;  // white paper around the black square, of its side: one module

/// A point in a marker's own frame: its black square is (0, 0) to (1, 1).
glm::dvec2 inMarker(const SimulatedMarker& marker, glm::dvec2 pointInWall) {
  const double angle = glm::radians(marker.roll);
  const glm::dvec2 off = pointInWall - marker.centre;
  const glm::dvec2 turned(std::cos(angle) * off.x + std::sin(angle) * off.y,
                          -std::sin(angle) * off.x + std::cos(angle) * off.y);
  return turned / marker.side + 0.5;
}

bool within(glm::dvec2 point, double low, double high) {
  return point.x >= low && point.x < high && point.y >= low && point.y < high;
}

bool onScreen(const Rig& rig, glm::dvec2 pointInWall) {
  const glm::dvec2 off = pointInWall - rig.screenTopLeft;
  return off.x >= 0 && off.y >= 0 && off.x < rig.screenSize.x && off.y < rig.screenSize.y;
}

/// Within reach of its paper at any angle, and a little more.
bool isNear(const SimulatedMarker& marker, glm::dvec2 pointInWall) {
  const glm::dvec2 off = glm::abs(pointInWall - marker.centre);
  return std::max(off.x, off.y) < 1.2 * marker.side;
}

bool nearMarker(const Rig& rig, glm::dvec2 pointInWall) {
  return std::ranges::any_of(rig.markers, [&](const auto& marker) { return isNear(marker, pointInWall); });
}

/// What a pixel's corner lies on; pixels whose corners differ, or that are near a marker, are sampled finely.
enum class Ground { kNowhere, kAround, kOnScreen, kByMarker };

struct Corner {
  glm::dvec2 pointInWall{0, 0};
  Ground ground = Ground::kNowhere;
};

class Looker {
 public:
  Looker(const Rig& rig, const RasterView& view) : rig_(rig), view_(view) {}

  void cornersOfRow(int y, std::vector<Corner>& corners) const {
    for (std::size_t x = 0; x < corners.size(); ++x) {
      const auto wall = view_.wallFromRaster({static_cast<double>(x), y});
      corners[x] = wall ? Corner{*wall, groundAt(*wall)} : Corner{};
    }
  }

  void lookAtRow(int y, const std::vector<Corner>& above, const std::vector<Corner>& below, RoomRaster& raster) const {
    for (int x = 0; x < view_.size().width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const std::array corners{above[i], above[i + 1], below[i], below[i + 1]};
      const glm::dvec2 middle =
          0.25 * (corners[0].pointInWall + corners[1].pointInWall + corners[2].pointInWall + corners[3].pointInWall);
      const double reflectance = average(corners);
      const double light = roomLightAt(rig_, middle) * view_.transmission({x + 0.5, y + 0.5});
      raster.reflectance.at(x, y) = static_cast<float>(reflectance);
      raster.ambient.at(x, y) = static_cast<float>(reflectance * light);
    }
  }

 private:
  [[nodiscard]] Ground groundAt(glm::dvec2 pointInWall) const {
    if (nearMarker(rig_, pointInWall)) return Ground::kByMarker;
    return onScreen(rig_, pointInWall) ? Ground::kOnScreen : Ground::kAround;
  }

  [[nodiscard]] double average(const std::array<Corner, 4>& corners) const {
    const Ground first = corners[0].ground;
    const auto isFirst = [first](const Corner& corner) { return corner.ground == first; };
    const auto isNothing = [](const Corner& corner) { return corner.ground == Ground::kNowhere; };
    if (std::ranges::any_of(corners, isNothing)) return kSurround;
    if (first != Ground::kByMarker && std::ranges::all_of(corners, isFirst))
      return first == Ground::kOnScreen ? 1 : kSurround;
    constexpr int kFine = 8;
    double sum = 0;
    for (int k = 0; k < kFine * kFine; ++k) {
      const double right = (k % kFine + 0.5) / kFine;
      const double down = (k / kFine + 0.5) / kFine;
      const glm::dvec2 top = corners[0].pointInWall + right * (corners[1].pointInWall - corners[0].pointInWall);
      const glm::dvec2 bottom = corners[2].pointInWall + right * (corners[3].pointInWall - corners[2].pointInWall);
      sum += reflectanceOfWall(rig_, top + down * (bottom - top));
    }
    return sum / (kFine * kFine);
  }

  const Rig& rig_;
  const RasterView& view_;
};

}  // namespace

double reflectanceOfWall(const Rig& rig, glm::dvec2 pointInWall) {
  for (const auto& marker : rig.markers) {
    if (!isNear(marker, pointInWall)) continue;
    const glm::dvec2 at = inMarker(marker, pointInWall);
    if (within(at, 0, 1)) return arucoIsWhite(marker.aruco, at.x, at.y) ? kPaper : kInk;
    if (within(at, -kQuietZone, 1 + kQuietZone)) return kPaper;
  }
  return onScreen(rig, pointInWall) ? 1 : kSurround;
}

double roomLightAt(const Rig& rig, glm::dvec2 pointInWall) {
  // Lamps above the left end: falling off to the right and downwards.
  const glm::dvec2 part = glm::clamp((pointInWall - rig.screenTopLeft) / rig.screenSize, -0.25, 1.25);
  return std::max(0.0, 1 - rig.room.gradient * (0.6 * part.x + 0.4 * part.y));
}

RoomRaster lookAtRoom(const Rig& rig, const RasterView& view) {
  RoomRaster raster{devices::ImageF(view.size(), 1), devices::ImageF(view.size(), 1)};
  const Looker looker(rig, view);
  inTwoHalves(view.size().height, [&](int first, int last) {
    std::vector<Corner> above(static_cast<std::size_t>(view.size().width) + 1);
    std::vector<Corner> below(above.size());
    looker.cornersOfRow(first, above);
    for (int y = first; y < last; ++y) {
      looker.cornersOfRow(y + 1, below);
      looker.lookAtRow(y, above, below, raster);
      std::swap(above, below);
    }
  });
  return raster;
}

}  // namespace pixelflex::calib
