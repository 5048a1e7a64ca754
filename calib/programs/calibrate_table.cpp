#include "calib/programs/calibrate_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace pixelflex::calib {
namespace {

std::string projectorLine(const ProjectorSummary& p, std::size_t width) {
  if (!p.calibrated) return fmt::format("{:<{}}  {}\n", p.name, width, p.note);
  return fmt::format("{:<{}}  {:>7}  {:>7.3f} {:>7.3f} {:>7.3f}  {:>7.3f}  {:>6.1f} %  {:>6.1f} %{}{}\n", p.name, width,
                     fmt::format("{}/{}", p.quality.found, p.quality.shown), p.quality.rms, p.quality.p95,
                     p.quality.maximum, p.density, p.overlapPercent, p.displayPercent, p.note.empty() ? "" : "  ",
                     p.note);
}

std::string formatFindings(const Summary& summary, const std::vector<Finding>& findings) {
  std::string lines = "\n" + verdict(summary, findings) + "\n";
  for (const auto& finding : findings) {
    lines += fmt::format("  {:<6}  {}: {}; {}\n", finding.severity == Severity::kBad ? "bad" : "notice", finding.where,
                         finding.what, finding.cure);
  }
  return lines;
}

}  // namespace

std::string formatTable(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  std::size_t width = std::string_view("projector").size();
  for (const auto& projector : summary.projectors) width = std::max(width, projector.name.size());
  const std::string units = wall.surface.wallUnits();
  std::string table = fmt::format("{:<{}}  {:>7}  {:>7} {:>7} {:>7}  {:>7}  {:>8}  {:>8}\n", "projector", width,
                                  "blobs", "rms px", "p95 px", "max px", "px/" + units, "overlap", "display");
  for (const auto& projector : summary.projectors) table += projectorLine(projector, width);
  if (const auto& camera = calibration.camera) {
    table += fmt::format("{:<{}}  {}x{}, ", "camera", width, camera->size.width, camera->size.height);
    table += camera->photos > 0 ? fmt::format("{} checkerboard photographs, reprojection {:.3f} px rms\n",
                                              camera->photos, camera->rmsPx)
                                : "known intrinsics\n";
  }
  if (const auto& surface = calibration.surface; surface && wall.surface.shape != SurfaceShape::kCamera) {
    table += fmt::format("{:<{}}  fiducials fit to {:.3f} {} rms\n", "surface", width, surface->rms, units);
  }
  if (const auto& d = calibration.display) {
    const double area = (d->right - d->left) * (d->bottom - d->top);
    const double litPercent = summary.lit.area > 0 ? 100 * area / summary.lit.area : 0;
    table += fmt::format("{:<{}}  {:.0f} x {:.0f} {} at ({:.0f}, {:.0f}), {:.0f} % of the lit area; desktop {}x{}\n",
                         "display", width, d->right - d->left, d->bottom - d->top, units, d->left, d->top, litPercent,
                         d->resolution.width, d->resolution.height);
  }
  if (const SeamFigures seams = seamFigures(summary.seams); seams.count > 0) {
    table += fmt::format("{:<{}}  {} overlaps, expected error {:.3f} px rms, {:.3f} px at worst ({})\n", "seams", width,
                         seams.count, seams.rms, seams.worst, seams.worstAt);
  }
  return table + formatFindings(summary, judge(wall, calibration, summary));
}

std::string formatDrifts(const std::vector<ProjectorDrift>& drifts) {
  std::size_t width = std::string_view("projector").size();
  for (const auto& projector : drifts) width = std::max(width, projector.name.size());
  std::string table = fmt::format("{:<{}}  {:>7}  {:>8} {:>8}  {:>7} {:>7}  {}\n", "projector", width, "blobs", "x px",
                                  "y px", "rms px", "max px", "verdict");
  for (const auto& [name, drift, verdict] : drifts) {
    table += fmt::format("{:<{}}  {:>7}  {:>+8.2f} {:>+8.2f}  {:>7.2f} {:>7.2f}  {}\n", name, width,
                         fmt::format("{}/{}", drift.found, drift.expected), drift.shift.x, drift.shift.y, drift.rms,
                         drift.maximum, verdict);
  }
  return table;
}

}  // namespace pixelflex::calib
