#include "calib/patterns/blob_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <opencv2/calib3d.hpp>

namespace pixelflex::calib {
namespace {

constexpr double kMostBend = 0.5;   // cells that a wide lens may bend the grid; a misread code is off by one at least
constexpr double kMostAside = 0.3;  // cells that a spot may lie beside where its neighbours expect it
constexpr std::size_t kFewestSpots = 8;

using Bits = std::array<int, kCodeBits>;  // which photograph is read as which bit

Homography toHomography(const cv::Mat& h) {
  std::array<double, 9> rowMajor{};
  std::copy_n(h.ptr<double>(), 9, rowMajor.begin());
  return Homography(rowMajor);
}

class Numbering {
 public:
  Numbering(const Spots& spots, const CodePhotos& codes, const BlobLayout& layout, const CameraMapping& camera,
            double cell)
      : codes_(codes), layout_(layout), cell_(cell) {
    for (std::size_t i = 0; i < spots.pointsInRaw.size(); ++i) {
      const glm::dvec2 raw = spots.pointsInRaw[i];
      all_.push_back({.pointInRaw = raw, .pointInUndistorted = camera.undistortedFromRaw(raw), .spot = i});
    }
  }

  Grid run() {
    Bits bits{};
    for (int bit = 0; bit < kCodeBits; ++bit) bits[static_cast<std::size_t>(bit)] = bit;
    Grid best = gridOf(bits);
    if (best.spots.size() * 10 < all_.size() * 7) trySwaps(bits, best);
    dropMisplaced(best);
    if (best.spots.size() >= kFewestSpots) addByPlace(best);
    for (auto& spot : best.spots) spot.confidence = confidenceOf(spot, best);
    std::ranges::sort(best.spots, {}, &GridSpot::id);
    return best;
  }

 private:
  void trySwaps(const Bits& bits, Grid& best) const {
    const std::size_t plain = best.spots.size();
    for (std::size_t i = 0; i < bits.size(); ++i) {
      for (std::size_t k = i + 1; k < bits.size(); ++k) {
        Bits swapped = bits;
        std::swap(swapped[i], swapped[k]);
        Grid grid = gridOf(swapped);
        // Chance makes a few more; a swap that was one makes all.
        if (grid.spots.size() < plain + all_.size() / 5 || grid.spots.size() <= best.spots.size()) continue;
        grid.swappedBits = std::pair(static_cast<int>(i), static_cast<int>(k));
        best = std::move(grid);
      }
    }
  }

  [[nodiscard]] double ratio(const GridSpot& spot, int photo) const {
    return codes_[static_cast<std::size_t>(photo)].ratio[spot.spot];
  }

  /// The seven bits, least significant first; 0 when one of them is nearly a coin toss.
  [[nodiscard]] int codeOf(const GridSpot& spot, const Bits& bits) const {
    int id = 0;
    for (int bit = 0; bit < kCodeBits; ++bit) {
      const double light = ratio(spot, bits[static_cast<std::size_t>(bit)]);
      if (std::abs(light - 0.5) < 0.1) return 0;
      if (light > 0.5) id |= 1 << bit;
    }
    return id <= kBlobCount ? id : 0;
  }

  /// A misread code puts a spot a whole cell away from where a homography expects it.
  [[nodiscard]] Grid gridOf(const Bits& bits) const {
    std::vector<GridSpot> coded;
    std::vector<cv::Point2d> from;
    std::vector<cv::Point2d> to;
    for (const auto& spot : all_) {
      const int id = codeOf(spot, bits);
      if (id == 0) continue;
      coded.push_back(spot);
      coded.back().id = id;
      from.emplace_back(layout_.centre(id).x, layout_.centre(id).y);
      to.emplace_back(spot.pointInUndistorted.x, spot.pointInUndistorted.y);
    }
    if (coded.size() < kFewestSpots) return {};
    cv::Mat inliers;
    const cv::Mat h = cv::findHomography(from, to, cv::RANSAC, kMostBend * cell_, inliers, 2000, 0.999);
    if (h.empty()) return {};
    Grid grid{.spots = {}, .cameraFromProjector = toHomography(h), .swappedBits = {}};
    std::map<int, GridSpot> nearest;
    for (std::size_t i = 0; i < coded.size(); ++i) {
      if (inliers.at<std::uint8_t>(static_cast<int>(i)) == 0) continue;
      const auto [kept, added] = nearest.emplace(coded[i].id, coded[i]);
      if (!added && aside(coded[i], grid) < aside(kept->second, grid)) kept->second = coded[i];
    }
    for (const auto& [id, spot] : nearest) grid.spots.push_back(spot);
    return grid;
  }

  [[nodiscard]] double aside(const GridSpot& spot, const Grid& grid) const {
    return glm::length(grid.cameraFromProjector.map(layout_.centre(spot.id)) - spot.pointInUndistorted);
  }

  /// Light thrown back by somebody before the wall stands beside the grid.
  void dropMisplaced(Grid& grid) const {
    if (grid.spots.size() < kFewestSpots) {
      grid.spots.clear();
      return;
    }
    std::vector<GridSpot> kept;
    for (const auto& spot : grid.spots) {
      const glm::dvec2 expected = mapAround(spot.id, grid, layout_, Self::kWithout).map(layout_.centre(spot.id));
      if (glm::length(expected - spot.pointInUndistorted) < kMostAside * cell_) kept.push_back(spot);
    }
    grid.spots = std::move(kept);
  }

  void addByPlace(Grid& grid) const {
    const Grid sure = grid;
    std::array<bool, kBlobCount + 1> taken{};
    std::vector<bool> used(all_.size());
    for (const auto& spot : sure.spots) {
      taken[static_cast<std::size_t>(spot.id)] = true;
      used[spot.spot] = true;
    }
    for (int id = 1; id <= kBlobCount; ++id) {
      if (taken[static_cast<std::size_t>(id)]) continue;
      const glm::dvec2 expected = mapAround(id, sure, layout_).map(layout_.centre(id));
      for (auto spot : all_) {
        if (used[spot.spot] || glm::length(expected - spot.pointInUndistorted) > kMostAside * cell_) continue;
        spot.id = id;
        if (contradictions(spot, sure) > 2) continue;
        used[spot.spot] = true;
        grid.spots.push_back(spot);
        break;
      }
    }
  }

  /// How sure the photograph is of the bit that this spot must have there: 1 is certain, -1 certain of the contrary.
  [[nodiscard]] double certainty(const GridSpot& spot, int bit, const Grid& grid) const {
    int photo = bit;
    if (grid.swappedBits) {
      if (bit == grid.swappedBits->first) photo = grid.swappedBits->second;
      if (bit == grid.swappedBits->second) photo = grid.swappedBits->first;
    }
    const double lit = std::clamp(2 * ratio(spot, photo) - 1, -1.0, 1.0);
    return ((spot.id >> bit) & 1) != 0 ? lit : -lit;
  }
  [[nodiscard]] int contradictions(const GridSpot& spot, const Grid& grid) const {
    int count = 0;
    for (int bit = 0; bit < kCodeBits; ++bit) count += certainty(spot, bit, grid) < -0.2 ? 1 : 0;
    return count;
  }
  [[nodiscard]] double confidenceOf(const GridSpot& spot, const Grid& grid) const {
    double least = 1;
    for (int bit = 0; bit < kCodeBits; ++bit) least = std::min(least, certainty(spot, bit, grid));
    return std::max(0.0, least);
  }

  const CodePhotos& codes_;
  const BlobLayout& layout_;
  double cell_;
  std::vector<GridSpot> all_;
};

}  // namespace

Grid numberSpots(const Spots& spots, const CodePhotos& codes, const BlobLayout& layout, const CameraMapping& camera,
                 double cell) {
  return Numbering(spots, codes, layout, camera, cell).run();
}

Homography mapAround(int id, const Grid& grid, const BlobLayout& layout, Self self) {
  constexpr std::size_t kNeighbours = 16;
  const glm::dvec2 centre = layout.centre(id);
  std::vector<const GridSpot*> nearest;
  for (const auto& spot : grid.spots) {
    if (self == Self::kWith || spot.id != id) nearest.push_back(&spot);
  }
  std::ranges::sort(nearest, {}, [&](const GridSpot* spot) { return glm::length(layout.centre(spot->id) - centre); });
  nearest.resize(std::min(nearest.size(), kNeighbours));
  std::vector<cv::Point2d> from;
  std::vector<cv::Point2d> to;
  for (const GridSpot* spot : nearest) {
    from.emplace_back(layout.centre(spot->id).x, layout.centre(spot->id).y);
    to.emplace_back(spot->pointInUndistorted.x, spot->pointInUndistorted.y);
  }
  if (from.size() < 5) return grid.cameraFromProjector;
  const cv::Mat h = cv::findHomography(from, to);
  return h.empty() ? grid.cameraFromProjector : toHomography(h);
}

}  // namespace pixelflex::calib
