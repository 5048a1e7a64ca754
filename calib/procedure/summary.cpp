#include "calib/procedure/summary.h"

#include "calib/geometry/projector_mapping.h"

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

void compareWithOthers(std::vector<ProjectorSummary>& all, std::size_t own) {
  auto& projector = all[own];
  if (!projector.calibrated) return;
  const double area = areaOf(projector.outline);
  std::vector<Outline> others;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == own || !all[i].calibrated) continue;
    const double shared = overlapArea(projector.outline, all[i].outline);
    if (shared <= 1e-4 * area) continue;
    projector.neighbours.push_back(all[i].name);
    others.push_back(all[i].outline);
  }
  if (others.empty()) {
    if (projector.note.empty() && all.size() > 1) projector.note = "overlaps no other projector";
    return;
  }
  // Lit by others as well: what the union would lose by taking this projector's own part out.
  const double othersArea = uniteFootprints(others).area;
  others.push_back(projector.outline);
  projector.overlapPercent = 100 * (area + othersArea - uniteFootprints(others).area) / area;
}

}  // namespace

Summary summarise(const Wall& wall, const Calibration& calibration) {
  Summary summary;
  for (const auto& config : wall.projectors) summary.projectors.push_back(describe(config, calibration));
  std::vector<Outline> outlines;
  for (const auto& projector : summary.projectors) {
    if (projector.calibrated) outlines.push_back(projector.outline);
  }
  if (!outlines.empty()) summary.lit = uniteFootprints(outlines);
  for (std::size_t i = 0; i < summary.projectors.size(); ++i) compareWithOthers(summary.projectors, i);
  for (auto& projector : summary.projectors) {
    if (!projector.calibrated || !calibration.display) continue;
    const double inside = overlapArea(projector.outline, displayOutline(*calibration.display));
    projector.displayPercent = 100 * inside / areaOf(projector.outline);
    if (inside <= 0) projector.note = "outside the display: shows nothing of the desktop";
  }
  return summary;
}

}  // namespace pixelflex::calib
