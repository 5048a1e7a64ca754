#include "calib/report/overlap_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "calib/geometry/footprint.h"
#include "calib/report/light_figures.h"

namespace pixelflex::calib {
namespace {

constexpr int kLattice = 48;        // points of an overlap's frame each way
constexpr int kPoints = 121;        // along a line
constexpr double kBeyond = 0.6;     // of the overlap's width, to each side
constexpr double kElongated = 1.3;  // overlaps shorter than this times their width have no direction of their own

std::optional<glm::dvec2> inFrame(const ProjectorMapping& mapping, glm::dvec2 pointInWall) {
  const auto p = mapping.projectorFromWall(pointInWall);
  if (!p || !mapping.insideFrame(*p)) return std::nullopt;
  return *p / glm::dvec2(mapping.resolution().width, mapping.resolution().height);
}

bool inDisplay(const Display& display, glm::dvec2 p) {
  return p.x >= display.left && p.x <= display.right && p.y >= display.top && p.y <= display.bottom;
}

struct Box {
  glm::dvec2 low, high;
};

Box boxOf(const Outline& outline) {
  Box box{glm::dvec2(1e300), glm::dvec2(-1e300)};
  for (const auto& point : outline) box = {glm::min(box.low, point), glm::max(box.high, point)};
  return box;
}

glm::dvec2 frameMiddle(const ProjectorMapping& mapping) {
  const glm::dvec2 middle = glm::dvec2(mapping.resolution().width, mapping.resolution().height) / 2.0;
  return mapping.wallFromProjector(middle).value_or(glm::dvec2(0));
}

/// Points of the display that both light.
std::vector<glm::dvec2> sharedPoints(const ProjectorMapping& first, const ProjectorMapping& second,
                                     const Display& display) {
  const Box a = boxOf(footprint(first));
  const Box b = boxOf(footprint(second));
  const glm::dvec2 low = glm::max(glm::max(a.low, b.low), glm::dvec2(display.left, display.top));
  const glm::dvec2 high = glm::min(glm::min(a.high, b.high), glm::dvec2(display.right, display.bottom));
  std::vector<glm::dvec2> points;
  if (low.x >= high.x || low.y >= high.y) return points;
  for (int i = 0; i < kLattice * kLattice; ++i) {
    const glm::dvec2 cell(i % kLattice + 0.5, static_cast<int>(i / kLattice) + 0.5);
    const glm::dvec2 point = low + (high - low) * cell / static_cast<double>(kLattice);
    if (inFrame(first, point) && inFrame(second, point)) points.push_back(point);
  }
  return points;
}

/// The direction in which points lie closest together; none where they lie as wide every way.
std::optional<glm::dvec2> narrowWay(const std::vector<glm::dvec2>& points, glm::dvec2 middle) {
  double xx = 0, xy = 0, yy = 0;
  for (const auto& point : points) {
    const glm::dvec2 d = point - middle;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
  }
  const double mean = (xx + yy) / 2;
  const double spread = std::hypot((xx - yy) / 2, xy);
  if (mean + spread < kElongated * kElongated * (mean - spread)) return std::nullopt;
  const double wide = std::atan2(xy, (xx - yy) / 2) / 2;
  return glm::dvec2(-std::sin(wide), std::cos(wide));
}

glm::dvec2 acrossWay(const std::vector<glm::dvec2>& points, glm::dvec2 middle, const ProjectorMapping& first,
                     const ProjectorMapping& second) {
  const glm::dvec2 between = frameMiddle(second) - frameMiddle(first);
  const double distance = glm::length(between);
  const glm::dvec2 fallback = distance > 0 ? between / distance : glm::dvec2(1, 0);
  const glm::dvec2 way = narrowWay(points, middle).value_or(fallback);
  // From left to right, or from top to bottom, whatever the order of the two.
  const bool back = std::abs(way.x) >= std::abs(way.y) ? way.x < 0 : way.y < 0;
  return back ? -way : way;
}

/// How far one may go from the middle while `holds`, in steps.
template <class Predicate>
double reach(const OverlapLine& line, double step, double from, double most, const Predicate& holds) {
  double distance = from;
  while (std::abs(distance + step) <= most && holds(line.at(distance + step))) distance += step;
  return distance;
}

constexpr std::array<std::uint8_t, 3> kWhite = {255, 255, 255};

double whiteAt(const WallLight& light, std::size_t projector, glm::dvec2 point, Correction correction) {
  const auto place = inFrame(light.mappings[projector], point);
  if (!place) return 0;
  const auto& own = light.projectors[projector];
  return luminanceOf(own.lightOf(own.placeAt(*place), kWhite, correction));
}

/// As if it lit the place alone, above its black.
std::optional<glm::dvec3> fullWhiteAt(const WallLight& light, std::size_t projector, glm::dvec2 point,
                                      Correction correction) {
  const auto inside = inFrame(light.mappings[projector], point);
  if (!inside) return std::nullopt;
  const auto& own = light.projectors[projector];
  FramePlace place = own.placeAt(*inside);
  place.share = 1;
  place.lift = glm::dvec3(0);
  return own.lightOf(place, kWhite, correction) - own.lightOf(place, {0, 0, 0}, correction);
}

}  // namespace

std::optional<OverlapLine> lineAcross(const ProjectorMapping& first, const ProjectorMapping& second,
                                      const Display& display) {
  const auto points = sharedPoints(first, second, display);
  if (points.empty()) return std::nullopt;
  OverlapLine line;
  for (const auto& point : points) line.middle += point / static_cast<double>(points.size());
  line.along = acrossWay(points, line.middle, first, second);
  const auto shown = [&](glm::dvec2 point) { return inDisplay(display, point); };
  const auto shared = [&](glm::dvec2 point) { return shown(point) && inFrame(first, point) && inFrame(second, point); };
  const double most = glm::length(glm::dvec2(display.right - display.left, display.bottom - display.top));
  const double step = most / 2000;
  line.overlapBegin = reach(line, -step, 0, most, shared);
  line.overlapEnd = reach(line, step, 0, most, shared);
  const double beyond = kBeyond * (line.overlapEnd - line.overlapBegin);
  line.begin = reach(line, -step, line.overlapBegin, std::abs(line.overlapBegin) + beyond, shown);
  line.end = reach(line, step, line.overlapEnd, line.overlapEnd + beyond, shown);
  if (line.end <= line.begin) return std::nullopt;
  return line;
}

Profile profileAlong(const OverlapLine& line, const WallLight& light, Correction correction) {
  Profile profile;
  profile.sum.assign(kPoints, 0);
  for (std::size_t i = 0; i < light.projectors.size(); ++i) {
    Profile::Part part{.projector = i, .luminance = std::vector<double>(kPoints)};
    bool lit = false;
    for (std::size_t k = 0; k < kPoints; ++k) {
      const double distance = line.begin + (line.end - line.begin) * static_cast<double>(k) / (kPoints - 1);
      part.luminance[k] = whiteAt(light, i, line.at(distance), correction);
      profile.sum[k] += part.luminance[k];
      lit = lit || part.luminance[k] > 0;
    }
    if (lit) profile.parts.push_back(std::move(part));
  }
  return profile;
}

OverlapDifference differenceOver(const OverlapLine& line, std::size_t first, std::size_t second, const WallLight& light,
                                 Correction correction) {
  glm::dvec3 one(0);
  glm::dvec3 two(0);
  double squares = 0;
  int count = 0;
  for (int k = 0; k < kPoints; ++k) {
    const glm::dvec2 point = line.at(line.overlapBegin + (line.overlapEnd - line.overlapBegin) * k / (kPoints - 1.0));
    const auto a = fullWhiteAt(light, first, point, correction);
    const auto b = fullWhiteAt(light, second, point, correction);
    if (!a || !b) continue;
    one += *a, two += *b, ++count;
    squares += std::pow(2 * (luminanceOf(*a) - luminanceOf(*b)) / (luminanceOf(*a) + luminanceOf(*b)), 2);
  }
  if (count == 0) return {};
  return {std::sqrt(squares / count), whiteDifference(one, two, commonWhite(light, correction))};
}

}  // namespace pixelflex::calib
