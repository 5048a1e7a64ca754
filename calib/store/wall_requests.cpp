#include "calib/store/wall_requests.h"

#include <string>

#include "calib/store/store_checks.h"
#include "calib/store/yaml_document.h"

namespace pixelflex::calib {
namespace {

using Node = YamlReader::Node;

constexpr double kTiny = 1e-6;
constexpr double kHuge = 1e9;

std::string wordOf(const Node& node, const std::string& whenAbsent) {
  if (!node.defined()) return whenAbsent;
  return node.isScalar() ? node.text() : "";
}

DesktopFilter readFilter(const Node& node) {
  const std::string text = wordOf(node, "catmull-rom");
  if (text == "bilinear") return DesktopFilter::kBilinear;
  if (text == "nearest") return DesktopFilter::kNearest;
  if (text != "catmull-rom") {
    node.problem("expected catmull-rom, bilinear or nearest, found " + quotedForMessage(text));
  }
  return DesktopFilter::kCatmullRom;
}

bool saysLinear(const Node& node) {
  const std::string text = wordOf(node, "srgb");
  if (text != "srgb" && text != "linear") node.problem("expected srgb or linear, found " + quotedForMessage(text));
  return text == "linear";
}

}  // namespace

DisplayRequest readDisplay(const Node& node) {
  DisplayRequest display;
  if (const Node aspect = node.optional("aspect"); aspect.defined()) {
    const std::string text = aspect.text();
    if (text != "any") display.aspect = parseAspect(text);
    if (text != "any" && !display.aspect) aspect.problem("expected any or W:H, e.g. 16:9");
  }
  if (const Node margin = node.optional("margin"); margin.defined()) display.margin = margin.integer(0, 4096);
  node.refuseUnknownKeys();
  return display;
}

DesktopRequest readDesktop(const Node& node) {
  DesktopRequest desktop;
  if (const Node density = node.optional("density"); density.defined()) {
    const std::string text = density.isScalar() ? density.text() : "";
    if (text == "max") desktop.density = DensityRule::kMax;
    if (text != "max" && text != "mean") {
      desktop.density = DensityRule::kFixed;
      desktop.pixelsPerUnit = density.number(kTiny, kHuge);
    }
  }
  if (const Node oversampling = node.optional("oversampling"); oversampling.defined()) {
    desktop.oversampling = oversampling.number(0.25, 8);
  }
  desktop.filter = readFilter(node.optional("filter"));
  if (saysLinear(node.optional("filter_domain"))) desktop.filterDomain = FilterDomain::kLinear;
  node.refuseUnknownKeys();
  return desktop;
}

Blend readBlend(const Node& node) {
  Blend blend;
  if (const Node n = node.optional("density_exponent"); n.defined()) blend.densityExponent = n.number(0, 16);
  if (const Node n = node.optional("priority_feather"); n.defined()) blend.priorityFeather = n.number(0, 4096);
  if (const Node stack = node.optional("stack"); stack.defined()) {
    const std::string text = stack.isScalar() ? stack.text() : "";
    if (text != "share" && text != "left-right") {
      stack.problem("expected share or left-right, found " + quotedForMessage(text));
    }
    blend.stack = text == "left-right" ? StackRule::kLeftRight : StackRule::kShare;
  }
  if (const Node uniformity = node.optional("uniformity"); uniformity.defined()) {
    if (!uniformity.isScalar() || uniformity.text() != "off") blend.uniformity = uniformity.number(0, 1);
  }
  if (const Node black = node.optional("black"); black.defined()) {
    const std::string text = black.isScalar() ? black.text() : "";
    if (text != "native" && text != "even") black.problem("expected native or even, found " + quotedForMessage(text));
    blend.evenBlack = text == "even";
  }
  node.refuseUnknownKeys();
  return blend;
}

Transfer readTransfer(const Node& node) {
  return saysLinear(node) ? Transfer::kLinear : Transfer::kSrgb;
}

}  // namespace pixelflex::calib
