#include "calib/store/store_checks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "calib/store/yaml_document.h"

namespace pixelflex::calib {
namespace {

using Node = YamlReader::Node;

std::optional<double> positiveNumber(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value >= 1e-3 && value <= 1e6 ? std::optional(value) : std::nullopt;
}

bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

double extentOf(const std::vector<Fiducial>& fiducials) {
  double extent = 0;
  for (const auto& fiducial : fiducials) {
    const glm::dvec2 offset = fiducial.pointInWall - fiducials.front().pointInWall;
    extent = std::max(extent, std::hypot(offset.x, offset.y));
  }
  return extent;
}

/// Whether at least two points are further than `tolerance` from the line through two others.
bool hasTwoBeside(const std::vector<Fiducial>& fiducials, glm::dvec2 origin, glm::dvec2 along, double tolerance) {
  int beside = 0;
  const double length = std::hypot(along.x, along.y);
  for (const auto& fiducial : fiducials) {
    const double distance = length > 0 ? std::abs(cross(along, fiducial.pointInWall - origin)) / length : 0;
    if (distance > tolerance && ++beside == 2) return true;
  }
  return false;
}

}  // namespace

std::string readText(const Node& node, std::size_t longest) {
  std::string text = node.text();
  if (node.isScalar() && text.empty()) node.problem("must not be empty");
  if (text.size() > longest) node.problem("longer than " + std::to_string(longest) + " bytes");
  return text;
}

std::string readName(const Node& node) {
  std::string name = readText(node, kMaxName);
  if (name.empty() || name.size() > kMaxName) return name;
  if (name.front() == '.' || !std::ranges::all_of(name, isNameCharacter)) {
    node.problem(quotedForMessage(name) + " may only hold letters, digits, '_', '-' and '.', and not begin with '.'");
  }
  return name;
}

glm::dvec2 readPoint(const Node& node) {
  const auto values = node.numbers(2, -kMaxCoordinate, kMaxCoordinate);
  return {values[0], values[1]};
}

glm::ivec2 readPixel(const Node& node, int minimum, int maximum) {
  const auto values = node.elements(2, 2);
  if (values.size() != 2) return {0, 0};
  return {values[0].integer(minimum, maximum), values[1].integer(minimum, maximum)};
}

devices::Size readSize(const Node& node, int minimum, int maximum) {
  const auto values = node.elements(2, 2);
  if (values.size() != 2) return {minimum, minimum};
  return {values[0].integer(minimum, maximum), values[1].integer(minimum, maximum)};
}

std::optional<glm::ivec2> readFlat(const Node& node, devices::Size resolution) {
  if (!node.defined()) return std::nullopt;
  const glm::ivec2 at = readPixel(node.required("at"), 0, kMaxExtent);
  if (at.x + resolution.width > kMaxExtent || at.y + resolution.height > kMaxExtent) {
    node.problem("this screen would show the desktop beyond pixel " + std::to_string(kMaxExtent));
  }
  node.refuseUnknownKeys();
  return at;
}

void checkUniqueNames(const Node& projectors) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    if (!projectors.at(i).isMap()) continue;
    const Node name = projectors.at(i).optional("name");
    if (!name.isScalar() || names.insert(name.text()).second) continue;
    name.problem("two projectors have the name " + quotedForMessage(name.text()));
  }
}

std::optional<AspectRatio> parseAspect(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto width = positiveNumber(text.substr(0, colon));
  const auto height = positiveNumber(text.substr(colon + 1));
  return width && height ? std::optional(AspectRatio{*width, *height}) : std::nullopt;
}

bool leavesCollineationOpen(const std::vector<Fiducial>& fiducials) {
  const double tolerance = extentOf(fiducials) / 1000;
  for (std::size_t i = 0; i < fiducials.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec2 origin = fiducials[j].pointInWall;
      const glm::dvec2 along = fiducials[i].pointInWall - origin;
      if (std::hypot(along.x, along.y) <= tolerance) continue;
      if (!hasTwoBeside(fiducials, origin, along, tolerance)) return true;
    }
  }
  return fiducials.size() < 4 || !(tolerance > 0);
}

}  // namespace pixelflex::calib
