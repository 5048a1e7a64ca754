#include "calib/procedure/summary.h"

#include <algorithm>
#include <cmath>

#include "calib/geometry/projector_mapping.h"
#include "calib/procedure/procedure.h"

namespace pixelflex::calib {
namespace {

Outline displayOutline(const Display& d) {
  return {{d.left, d.top}, {d.right, d.top}, {d.right, d.bottom}, {d.left, d.bottom}};
}

ProjectorSummary describe(const ProjectorConfig& config, const Calibration& calibration) {
  ProjectorSummary summary;
  summary.name = config.name;
  const ProjectorCalibration* projector = calibration.find(config.name);
  if (projector == nullptr) {
    summary.note = "not calibrated";
    return summary;
  }
  const ProjectorMapping mapping(*projector);
  summary.calibrated = true;
  summary.quality = projector->quality;
  summary.density = mapping.meanDensity();
  summary.outline = footprint(mapping);
  return summary;
}

void findNeighbours(const std::vector<Seam>& seams, std::vector<ProjectorSummary>& all) {
  for (auto& projector : all) {
    for (const auto& seam : seams) {
      if (seam.first == projector.name) projector.neighbours.push_back(seam.second);
      if (seam.second == projector.name) projector.neighbours.push_back(seam.first);
    }
    if (projector.calibrated && projector.neighbours.empty() && all.size() > 1) {
      projector.note = "overlaps no other projector";
    }
  }
}

/// The part of a footprint that others light as well, by counting points of the frame, each for the wall it lights.
double overlapOf(const ProjectorCalibration& own, const std::vector<ProjectorMapping>& others) {
  constexpr int kSteps = 96;
  const ProjectorMapping mapping(own);
  const glm::dvec2 step = glm::dvec2(own.resolution.width, own.resolution.height) / double{kSteps};
  double all = 0, shared = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const glm::dvec2 p = step * glm::dvec2(i % kSteps + 0.5, static_cast<int>(i / kSteps) + 0.5);
    const auto inWall = mapping.wallFromProjector(p);
    const double density = mapping.density(p);
    if (!inWall || density <= 0) continue;
    const double area = 1 / (density * density);
    all += area;
    const auto lights = [&](const ProjectorMapping& other) {
      const auto there = other.projectorFromWall(*inWall);
      return there && other.insideFrame(*there);
    };
    if (std::ranges::any_of(others, lights)) shared += area;
  }
  return all > 0 ? 100 * shared / all : 0;
}

void describeOverlap(const Calibration& calibration, ProjectorSummary& projector) {
  std::vector<ProjectorMapping> others;
  for (const auto& name : projector.neighbours) {
    if (const auto* other = calibration.find(name)) others.emplace_back(*other);
  }
  const auto* own = calibration.find(projector.name);
  if (own != nullptr && !others.empty()) projector.overlapPercent = overlapOf(*own, others);
}

void compareWithDisplay(const Display& display, ProjectorSummary& projector) {
  const double inside = overlapArea(projector.outline, displayOutline(display));
  projector.displayPercent = 100 * inside / areaOf(projector.outline);
  projector.desktopDensity = projector.density / desktopPixelsPerUnit(display);
  if (inside <= 0) projector.note = "outside the display: shows nothing of the desktop";
}

std::vector<std::string> missingSteps(const Wall& wall, const Calibration& calibration) {
  std::vector<std::string> missing;
  if (wall.isFlat()) return missing;
  for (const auto& step : stepNames()) {
    if (!calibration.steps.contains(step)) missing.push_back(step);
  }
  return missing;
}

}  // namespace

double desktopPixelsPerUnit(const Display& d) {
  return std::sqrt(static_cast<double>(d.resolution.area()) / ((d.right - d.left) * (d.bottom - d.top)));
}

Summary summarise(const Wall& wall, const Calibration& calibration) {
  Summary summary;
  for (const auto& config : wall.projectors) summary.projectors.push_back(describe(config, calibration));
  std::vector<Outline> outlines;
  for (const auto& projector : summary.projectors) {
    if (projector.calibrated) outlines.push_back(projector.outline);
  }
  if (!outlines.empty()) summary.lit = uniteFootprints(outlines);
  summary.seams = findSeams(calibration);
  findNeighbours(summary.seams, summary.projectors);
  for (auto& projector : summary.projectors) {
    if (!projector.calibrated) continue;
    describeOverlap(calibration, projector);
    if (calibration.display) compareWithDisplay(*calibration.display, projector);
  }
  summary.missingSteps = missingSteps(wall, calibration);
  return summary;
}

}  // namespace pixelflex::calib
