#include "calib/geometry/patch_mesh.h"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace pixelflex::calib {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Exact>;
using Fast = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
constexpr int kUnvisited = -1;
constexpr int kOutside = 0;

struct VertexInfo {
  std::uint32_t index = kNoVertex;
};
struct FaceInfo {
  int component = kUnvisited;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Fast>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Fast, CGAL::Constrained_triangulation_face_base_2<Fast>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Fast, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

using Vertex = Triangulation::Vertex_handle;

constexpr int kMostHalvings = 3;  // of the distance between vertices

/// Doubles with an order, for finding a point again that two patches share to the last bit.
using PointKey = std::pair<double, double>;

class MeshBuilder {
 public:
  MeshBuilder(const ProjectorMapping& mapping, const Display& display, std::span<const DesktopPatch> patches,
              double spacing)
      : mapping_(mapping), display_(display), patches_(patches), spacing_(spacing), view_(mapping, display) {}

  PatchMesh build() {
    traceOutline();
    for (const auto& patch : patches_) insertPatchBorder(patch);
    if (triangulation_.number_of_vertices() < 3) return {};
    fillInterior();
    nameIntersections();
    markComponents();
    return collect();
  }

 private:
  /// The footprint in desktop pixels, remembering which point of the frame each of its vertices came from.
  void traceOutline() {
    const double w = mapping_.resolution().width;
    const double h = mapping_.resolution().height;
    const std::array<glm::dvec2, 4> corners = {{{0, 0}, {w, 0}, {w, h}, {0, h}}};
    const Outline outline = footprint(mapping_);
    const Homography desktopOf = desktopFromWall(display_);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 inDesktop = desktopOf.map(outline[i]);
      const std::size_t edge = i / kOutlinePointsPerEdge;
      const double along = double(i % kOutlinePointsPerEdge) / kOutlinePointsPerEdge;
      projectorOf_[{inDesktop.x, inDesktop.y}] = corners[edge] + (corners[(edge + 1) % 4] - corners[edge]) * along;
      outline_.push_back({inDesktop.x, inDesktop.y});
    }
    if (!outline_.is_simple()) throw GeometryError("the projector's outline on the wall crosses itself");
    if (outline_.is_clockwise_oriented()) outline_.reverse_orientation();
  }

  /// Patch AND footprint; the result's border becomes constraint edges in projector space.
  void insertPatchBorder(const DesktopPatch& patch) {
    ExactPolygon rectangle;
    rectangle.push_back({patch.left, patch.top});
    rectangle.push_back({patch.right, patch.top});
    rectangle.push_back({patch.right, patch.bottom});
    rectangle.push_back({patch.left, patch.bottom});
    std::vector<CGAL::Polygon_with_holes_2<Exact>> parts;
    CGAL::intersection(rectangle, outline_, std::back_inserter(parts));
    for (const auto& part : parts) {
      const auto& border = part.outer_boundary();
      for (auto edge = border.edges_begin(); edge != border.edges_end(); ++edge) insertEdge(*edge, patch);
    }
  }

  static glm::dvec2 pointOf(const Exact::Point_2& point) {
    // exact() first: the same rational gives the same double, however it was arrived at, on both sides of a border.
    return {CGAL::to_double(CGAL::exact(point).x()), CGAL::to_double(CGAL::exact(point).y())};
  }

  /// A straight border of the patch is a curve in projector space: give it points at fixed desktop positions, which its
  /// neighbour finds as well.
  void insertEdge(const Exact::Segment_2& edge, const DesktopPatch& patch) {
    const glm::dvec2 from = pointOf(edge.source());
    const glm::dvec2 to = pointOf(edge.target());
    const bool vertical = from.x == to.x && (from.x == patch.left || from.x == patch.right);
    const bool horizontal = from.y == to.y && (from.y == patch.top || from.y == patch.bottom);
    if (!vertical && !horizontal) return insertFrameEdge(insertVertex(from), insertVertex(to), 0);
    const int axis = vertical ? 1 : 0;
    auto last = insertVertex(from);
    for (const double stop : stopsBetween(from[axis], to[axis])) {
      glm::dvec2 point = from;
      point[axis] = stop;
      const auto next = insertVertex(point);
      insertPatchEdge(last, next, 0);
      last = next;
    }
    insertPatchEdge(last, insertVertex(to), 0);
  }

  /// Halved, at the same places from both sides, until its chord follows the curve.
  void insertPatchEdge(Vertex from, Vertex to, int halvings) {
    if (from == to) return;
    if (halvings == kMostHalvings || view_.followsOnDesktop(named(from), named(to))) {
      triangulation_.insert_constraint(from, to);
      return;
    }
    const auto between = insertVertex((named(from).pointInDesktop + named(to).pointInDesktop) / 2.0);
    insertPatchEdge(from, between, halvings + 1);
    insertPatchEdge(between, to, halvings + 1);
  }

  /// Of the frame's border: straight in projector space, so halved there.
  void insertFrameEdge(Vertex from, Vertex to, int halvings) {
    if (from == to) return;
    const glm::dvec2 middle = (named(from).pointInProjector + named(to).pointInProjector) / 2.0;
    const auto inDesktop = view_.desktopFromProjector(middle);
    if (halvings == kMostHalvings || !inDesktop || view_.followsInFrame(named(from), named(to))) {
      triangulation_.insert_constraint(from, to);
      return;
    }
    const auto between = insertPoint(middle, *inDesktop);
    insertFrameEdge(from, between, halvings + 1);
    insertFrameEdge(between, to, halvings + 1);
  }

  [[nodiscard]] MeshVertex named(const Vertex& handle) const { return mesh_.vertices[handle->info().index]; }

  [[nodiscard]] static std::vector<double> stopsBetween(double from, double to) {
    constexpr double kStep = 16;  // desktop pixels
    std::vector<double> stops;
    const auto [low, high] = std::minmax(from, to);
    for (double stop = (std::floor(low / kStep) + 1) * kStep; stop < high; stop += kStep) {
      if (stop - low > 1 && high - stop > 1) stops.push_back(stop);
    }
    if (from > to) std::ranges::reverse(stops);
    return stops;
  }

  Vertex insertVertex(glm::dvec2 pointInDesktop) {
    const PointKey key{pointInDesktop.x, pointInDesktop.y};
    if (const auto known = handleOf_.find(key); known != handleOf_.end()) return known->second;
    const auto onFrame = projectorOf_.find(key);
    const glm::dvec2 inProjector =
        onFrame != projectorOf_.end() ? onFrame->second : view_.projectorFromDesktop(pointInDesktop);
    const auto handle = triangulation_.insert({inProjector.x, inProjector.y});
    if (handle->info().index == kNoVertex) nameVertex(handle, inProjector, pointInDesktop);
    handleOf_[key] = handle;
    return handle;
  }

  void nameVertex(const Vertex& handle, glm::dvec2 inProjector, glm::dvec2 inDesktop) {
    handle->info().index = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(view_.vertex(inProjector, inDesktop));
  }

  void fillInterior() {
    const double w = mapping_.resolution().width;
    const double h = mapping_.resolution().height;
    const int columns = std::max(1, static_cast<int>(std::lround(w / spacing_)));
    const int rows = std::max(1, static_cast<int>(std::lround(h / spacing_)));
    const glm::dvec2 size(w / columns, h / rows);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const glm::dvec2 low = size * glm::dvec2(column, row);
        if (row > 0 && column > 0) insertInterior(low);
        refineCell(low, size, 0);
      }
    }
  }

  /// Quarters a cell of the lattice until the model is straight within it. Points that neighbours share are found
  /// again.
  void refineCell(glm::dvec2 low, glm::dvec2 size, int halvings) {
    if (halvings == kMostHalvings || view_.followsInCell(low, size)) return;
    const glm::dvec2 half = size / 2.0;
    for (const glm::dvec2 place :
         {glm::dvec2(1, 1), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(2, 1), glm::dvec2(1, 2)}) {
      insertInterior(low + half * place);
    }
    for (const glm::dvec2 quarter : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
      refineCell(low + half * quarter, half, halvings + 1);
    }
  }

  void insertInterior(glm::dvec2 inProjector) {
    const bool insideFrame = inProjector.x > 0 && inProjector.y > 0 && inProjector.x < mapping_.resolution().width &&
                             inProjector.y < mapping_.resolution().height;
    const auto inDesktop = view_.desktopFromProjector(inProjector);
    if (insideFrame && inDesktop && clearOfBorders(*inDesktop)) near_ = insertPoint(inProjector, *inDesktop)->face();
  }

  /// Inside a patch, and not so near to its border that a sliver would come between.
  [[nodiscard]] bool clearOfBorders(glm::dvec2 p) const {
    constexpr double kClearance = 1;  // desktop pixels
    const auto index = patchAt(p);
    if (!index) return false;
    const DesktopPatch& patch = patches_[*index];
    return p.x > patch.left + kClearance && p.y > patch.top + kClearance && p.x < patch.right - kClearance &&
           p.y < patch.bottom - kClearance;
  }

  Vertex insertPoint(glm::dvec2 inProjector, glm::dvec2 inDesktop) {
    const auto handle = triangulation_.insert({inProjector.x, inProjector.y}, near_);
    if (handle->info().index == kNoVertex) nameVertex(handle, inProjector, inDesktop);
    return handle;
  }

  /// Where two constraints cross, the triangulation made a point of its own.
  void nameIntersections() {
    for (auto vertex : triangulation_.finite_vertex_handles()) {
      if (vertex->info().index != kNoVertex) continue;
      const glm::dvec2 inProjector{vertex->point().x(), vertex->point().y()};
      const auto inDesktop = view_.desktopFromProjector(inProjector);
      if (!inDesktop) throw GeometryError("a mesh point falls outside the projector's lens model");
      nameVertex(vertex, inProjector, *inDesktop);
    }
  }

  /// Faces reached from infinity without crossing a constraint lie outside; the rest falls into one or more components
  /// per patch.
  void markComponents() {
    flood(triangulation_.infinite_face(), kOutside);
    componentCount_ = 1;
    for (auto face : triangulation_.finite_face_handles()) {
      if (face->info().component == kUnvisited) flood(face, componentCount_++);
    }
  }

  void flood(const Triangulation::Face_handle& start, int component) {
    std::deque<Triangulation::Face_handle> waiting{start};
    start->info().component = component;
    while (!waiting.empty()) {
      const auto face = waiting.front();
      waiting.pop_front();
      for (int edge = 0; edge < 3; ++edge) {
        const auto neighbour = face->neighbor(edge);
        if (neighbour->info().component != kUnvisited || face->is_constrained(edge)) continue;
        neighbour->info().component = component;
        waiting.push_back(neighbour);
      }
    }
  }

  [[nodiscard]] glm::dvec2 desktopCentre(const Triangulation::Face_handle& face) const {
    glm::dvec2 sum{0, 0};
    for (int corner = 0; corner < 3; ++corner) sum += mesh_.vertices[face->vertex(corner)->info().index].pointInDesktop;
    return sum / 3.0;
  }

  [[nodiscard]] double desktopArea(const Triangulation::Face_handle& face) const {
    std::array<glm::dvec2, 3> p{};
    for (int corner = 0; corner < 3; ++corner) {
      p[static_cast<std::size_t>(corner)] = mesh_.vertices[face->vertex(corner)->info().index].pointInDesktop;
    }
    const glm::dvec2 u = p[1] - p[0];
    const glm::dvec2 v = p[2] - p[0];
    return std::abs(u.x * v.y - u.y * v.x) / 2;
  }

  [[nodiscard]] std::optional<std::size_t> patchAt(glm::dvec2 pointInDesktop) const {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      const auto& patch = patches_[i];
      if (pointInDesktop.x >= patch.left && pointInDesktop.x < patch.right && pointInDesktop.y >= patch.top &&
          pointInDesktop.y < patch.bottom) {
        return i;
      }
    }
    return std::nullopt;
  }

  /// A component lies in one patch; its largest triangle says which, free of the rounding that a sliver suffers.
  [[nodiscard]] std::vector<std::optional<std::size_t>> patchOfComponents() const {
    std::vector<double> largest(static_cast<std::size_t>(componentCount_), -1);
    std::vector<std::optional<std::size_t>> patchOf(static_cast<std::size_t>(componentCount_));
    for (auto face : triangulation_.finite_face_handles()) {
      const auto component = static_cast<std::size_t>(face->info().component);
      const double area = desktopArea(face);
      if (face->info().component == kOutside || area <= largest[component]) continue;
      largest[component] = area;
      patchOf[component] = patchAt(desktopCentre(face));
    }
    return patchOf;
  }

  PatchMesh collect() {
    const auto patchOf = patchOfComponents();
    std::map<std::size_t, PatchTriangles> byPatch;
    for (auto face : triangulation_.finite_face_handles()) {
      const auto patch = patchOf[static_cast<std::size_t>(face->info().component)];
      if (!patch) continue;
      auto& part = byPatch[*patch];
      part.patch = *patch;
      part.triangles.push_back(
          {face->vertex(0)->info().index, face->vertex(1)->info().index, face->vertex(2)->info().index});
    }
    for (auto& [patch, part] : byPatch) mesh_.patches.push_back(std::move(part));
    return std::move(mesh_);
  }

  const ProjectorMapping& mapping_;
  const Display& display_;
  std::span<const DesktopPatch> patches_;
  double spacing_;
  DesktopView view_;
  ExactPolygon outline_;
  std::map<PointKey, glm::dvec2> projectorOf_;
  std::map<PointKey, Vertex> handleOf_;
  Triangulation triangulation_;
  Triangulation::Face_handle near_;  // where the last point went in
  int componentCount_ = 0;
  PatchMesh mesh_;
};

}  // namespace

PatchMesh buildPatchMesh(const ProjectorMapping& mapping, const Display& display, std::span<const DesktopPatch> patches,
                         double spacing) {
  return MeshBuilder(mapping, display, patches, spacing).build();
}

}  // namespace pixelflex::calib
