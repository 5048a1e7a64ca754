#include "viewer/renderer/mesh_footprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

/// Desktop pixels around a texel whose colour it can change: half of a 4x4 filter, and room for rounding.
constexpr float kFilterReach = 2.125F;
constexpr float kFar = 1e9F;

/// A point of a triangle that is being cut: desktop position times weight, and where it is in the projector.
struct CutVertex {
  double uw = 0, vw = 0, w = 1;
  double x = 0, y = 0;
};
using Polygon = std::vector<CutVertex>;

/// Keeps the part where a*uw + b*vw + c*w >= 0: linear in what varies linearly over the triangle, so exact.
Polygon cutBy(const Polygon& polygon, double a, double b, double c) {
  Polygon kept;
  const auto side = [&](const CutVertex& v) { return a * v.uw + b * v.vw + c * v.w; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& from = polygon[i];
    const auto& to = polygon[(i + 1) % polygon.size()];
    const double sideFrom = side(from);
    const double sideTo = side(to);
    if (sideFrom >= 0) kept.push_back(from);
    if ((sideFrom >= 0) == (sideTo >= 0)) continue;
    const double t = sideFrom / (sideFrom - sideTo);
    const auto mix = [t](double p, double q) { return p + t * (q - p); };
    kept.push_back({mix(from.uw, to.uw), mix(from.vw, to.vw), mix(from.w, to.w), mix(from.x, to.x), mix(from.y, to.y)});
  }
  return kept;
}

void check(const OutputPlan& plan, const WarpPatch& patch, const TileLayout& layout) {
  const auto end = std::uint64_t{patch.firstIndex} + patch.indexCount;
  if (patch.layer < 0 || patch.layer >= layout.count() || end > plan.mesh.indices.size() || patch.indexCount % 3 != 0) {
    throw RendererError(
        fmt::format("the warp mesh of '{}' has a patch (tile {}, indices {} to {}) outside the desktop "
                    "or the mesh",
                    plan.name, patch.layer, patch.firstIndex, end));
  }
}

const WarpVertex& cornerOf(const OutputPlan& plan, std::size_t index) {
  const auto number = plan.mesh.indices[index];
  if (number >= plan.mesh.vertices.size()) {
    throw RendererError(fmt::format("the warp mesh of '{}' has no vertex {}", plan.name, number));
  }
  const auto& v = plan.mesh.vertices[number];
  const bool finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.uw) && std::isfinite(v.vw);
  if (!finite || !(v.w > 0) || !std::isfinite(v.w)) {
    throw RendererError(
        fmt::format("the warp mesh of '{}' has a vertex ({}) that is not finite or has no positive "
                    "weight",
                    plan.name, number));
  }
  return v;
}

Box enclosingPixels(double left, double top, double right, double bottom, devices::Size resolution) {
  const Box box{static_cast<int>(std::floor(left)) - 1, static_cast<int>(std::floor(top)) - 1,
                static_cast<int>(std::ceil(right)) + 1, static_cast<int>(std::ceil(bottom)) + 1};
  return intersect(box, boxOf(resolution));
}

}  // namespace

MeshFootprint::MeshFootprint(const OutputPlan& plan, const TileLayout& layout)
    : resolution_(plan.resolution), desktop_(plan.desktop) {
  for (const auto& patch : plan.mesh.patches) addPatch(plan, patch, layout);
  std::sort(layers_.begin(), layers_.end());
  layers_.erase(std::unique(layers_.begin(), layers_.end()), layers_.end());
}

void MeshFootprint::grow(Bounds& bounds, float x, float y) {
  bounds = {std::min(bounds.left, x), std::min(bounds.top, y), std::max(bounds.right, x), std::max(bounds.bottom, y)};
}

void MeshFootprint::addPatch(const OutputPlan& plan, const WarpPatch& patch, const TileLayout& layout) {
  check(plan, patch, layout);
  const auto origin = layout.origin(patch.layer);
  constexpr Bounds kNothing{kFar, kFar, -kFar, -kFar};
  Patch added{kNothing, inDesktop_.size(), patch.indexCount / 3, origin};
  for (std::size_t triangle = 0; triangle < added.triangleCount; ++triangle) {
    auto inDesktop = kNothing;
    auto inProjector = kNothing;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& v = cornerOf(plan, patch.firstIndex + triangle * 3 + corner);
      const auto texel = [&v](float weighted, int from) {
        return static_cast<float>(double{weighted} - double{v.w} * from);
      };
      vertices_.push_back({v.x, v.y, texel(v.uw, origin.x), texel(v.vw, origin.y), v.w, patch.layer});
      grow(inDesktop, v.uw / v.w, v.vw / v.w);
      grow(inProjector, v.x, v.y);
    }
    inDesktop_.push_back(inDesktop);
    inProjector_.push_back(inProjector);
    grow(added.inDesktop, inDesktop.left, inDesktop.top);
    grow(added.inDesktop, inDesktop.right, inDesktop.bottom);
  }
  patches_.push_back(added);
  layers_.push_back(patch.layer);
}

bool MeshFootprint::overlap(const Bounds& a, const Bounds& b) {
  return a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom;
}

/// Where a position must be to read one of these pixels. At the desktop's border the outermost pixel goes on for ever.
MeshFootprint::Bounds MeshFootprint::reachOf(const Box& box) const {
  return {box.left <= 0 ? -kFar : static_cast<float>(box.left) - kFilterReach,
          box.top <= 0 ? -kFar : static_cast<float>(box.top) - kFilterReach,
          box.right >= desktop_.width ? kFar : static_cast<float>(box.right) + kFilterReach,
          box.bottom >= desktop_.height ? kFar : static_cast<float>(box.bottom) + kFilterReach};
}

Box MeshFootprint::touchedBy(const Box& desktopBox) const {
  const auto inside = intersect(desktopBox, boxOf(desktop_));
  if (inside.empty()) return {};
  const auto reach = reachOf(inside);
  double left = kFar;
  double top = kFar;
  double right = -kFar;
  double bottom = -kFar;
  for (const auto& patch : patches_) {
    if (!overlap(patch.inDesktop, reach)) continue;
    for (std::size_t i = patch.firstTriangle; i < patch.firstTriangle + patch.triangleCount; ++i) {
      if (!overlap(inDesktop_[i], reach)) continue;
      Polygon polygon;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto& v = vertices_[3 * i + corner];
        polygon.push_back(
            {double{v.uw} + double{v.w} * patch.origin.x, double{v.vw} + double{v.w} * patch.origin.y, v.w, v.x, v.y});
      }
      polygon = cutBy(polygon, 1, 0, -double{reach.left});
      polygon = cutBy(polygon, -1, 0, double{reach.right});
      polygon = cutBy(polygon, 0, 1, -double{reach.top});
      polygon = cutBy(polygon, 0, -1, double{reach.bottom});
      for (const auto& v : polygon) {
        left = std::min(left, v.x);
        top = std::min(top, v.y);
        right = std::max(right, v.x);
        bottom = std::max(bottom, v.y);
      }
    }
  }
  if (left > right) return {};
  return enclosingPixels(left, top, right, bottom, resolution_);
}

std::vector<VertexRun> MeshFootprint::trianglesIn(const Box& box) const {
  const Bounds wanted{static_cast<float>(box.left), static_cast<float>(box.top), static_cast<float>(box.right),
                      static_cast<float>(box.bottom)};
  std::vector<VertexRun> runs;
  for (std::size_t i = 0; i < inProjector_.size(); ++i) {
    if (!overlap(inProjector_[i], wanted)) continue;
    const auto first = static_cast<std::int32_t>(3 * i);
    if (!runs.empty() && runs.back().first + runs.back().count == first) {
      runs.back().count += 3;
    } else {
      runs.push_back({first, 3});
    }
  }
  return runs;
}

}  // namespace pixelflex::viewer
