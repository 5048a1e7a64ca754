#include "calib/geometry/footprint.h"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace pixelflex::calib {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using PolygonWithHoles = CGAL::Polygon_with_holes_2<Kernel>;

Polygon polygonOf(const Outline& outline) {
  Polygon polygon;
  for (const auto& point : outline) polygon.push_back({point.x, point.y});
  if (!polygon.is_simple()) throw GeometryError("a projector's outline on the wall crosses itself");
  if (polygon.is_clockwise_oriented()) polygon.reverse_orientation();
  return polygon;
}

Outline outlineOf(const Polygon& polygon) {
  Outline outline;
  for (const auto& point : polygon.vertices()) {
    outline.emplace_back(CGAL::to_double(point.x()), CGAL::to_double(point.y()));
  }
  return outline;
}

}  // namespace

Outline footprint(const ProjectorMapping& mapping) {
  const double w = mapping.resolution().width;
  const double h = mapping.resolution().height;
  const std::array<glm::dvec2, 4> corners = {{{0, 0}, {w, 0}, {w, h}, {0, h}}};
  Outline outline;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const glm::dvec2 from = corners[edge];
    const glm::dvec2 along = corners[(edge + 1) % 4] - from;
    for (int i = 0; i < kOutlinePointsPerEdge; ++i) {
      const auto point = mapping.wallFromProjector(from + along * (double(i) / kOutlinePointsPerEdge));
      if (!point) throw GeometryError("part of the frame does not reach the wall");
      outline.push_back(*point);
    }
  }
  return outline;
}

double areaOf(std::span<const glm::dvec2> outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[(i + 1) % outline.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

LitArea uniteFootprints(std::span<const Outline> footprints) {
  CGAL::Polygon_set_2<Kernel> united;
  for (const auto& outline : footprints) united.join(polygonOf(outline));
  std::vector<PolygonWithHoles> parts;
  united.polygons_with_holes(std::back_inserter(parts));
  LitArea lit;
  for (const auto& part : parts) {
    lit.islands.push_back(outlineOf(part.outer_boundary()));
    lit.area += areaOf(lit.islands.back());
    for (const auto& hole : part.holes()) {
      lit.holes.push_back(outlineOf(hole));
      lit.area -= areaOf(lit.holes.back());
    }
  }
  std::ranges::sort(lit.islands, std::greater<>(), [](const Outline& outline) { return areaOf(outline); });
  return lit;
}

double overlapArea(const Outline& a, const Outline& b) {
  std::vector<PolygonWithHoles> parts;
  CGAL::intersection(polygonOf(a), polygonOf(b), std::back_inserter(parts));
  double area = 0;
  for (const auto& part : parts) area += areaOf(outlineOf(part.outer_boundary()));
  return area;
}

}  // namespace pixelflex::calib
