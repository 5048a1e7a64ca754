#include "calib/procedure/verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "calib/geometry/display_area.h"
#include "calib/procedure/projector_verdicts.h"

namespace pixelflex::calib {
namespace {

// Where good ends. Errors in projector pixels; the eye finds doubled edges from about a quarter of one.
constexpr double kNoticeSeam = 0.25, kBadSeam = 0.6;
constexpr double kNoticeFiducial = 2, kBadFiducial = 8;              // projector pixels
constexpr double kNoticeReprojection = 0.5, kBadReprojection = 1.5;  // camera pixels
constexpr int kFewBoards = 8;
constexpr double kNarrowOverlap = 5;  // per cent
constexpr double kNarrowBlend = 24;   // desktop pixels
constexpr double kMostlyShared = 60;  // per cent of an overlap: its blend is made by the others as well
constexpr double kDensityRatio = 1.5;
constexpr double kLittleOfTheLit = 0.6;

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

class Judge {
 public:
  Judge(const Wall& wall, const Calibration& calibration, const Summary& summary)
      : wall_(wall), calibration_(calibration), summary_(summary) {}

  std::vector<Finding> run() {
    judgeCamera();
    judgeSurface();
    for (const auto& projector : summary_.projectors) {
      std::ranges::move(judgeProjector(calibration_, projector), std::back_inserter(findings_));
    }
    for (const auto& seam : summary_.seams) judgeSeam(seam);
    judgeDisplay();
    judgeStore();
    std::ranges::stable_sort(findings_, std::greater<>(), &Finding::severity);
    return std::move(findings_);
  }

 private:
  void add(Severity severity, std::string where, std::string what, std::string cause, std::string cure) {
    findings_.push_back({severity, std::move(where), std::move(what), std::move(cause), std::move(cure)});
  }
  static Severity above(double value, double bad) { return value > bad ? Severity::kBad : Severity::kNotice; }

  void judgeCamera() {
    const auto& camera = calibration_.camera;
    if (!camera || camera->photos == 0) return;
    if (camera->rmsPx > kNoticeReprojection) {
      add(above(camera->rmsPx, kBadReprojection), "camera",
          fmt::format("checkerboard corners are reproduced to {:.2f} camera pixels only", camera->rmsPx),
          "a bent or soft board, motion blur, or autofocus between the photographs",
          "fix the print to something flat, focus by hand, and photograph the board again");
    }
    if (camera->photos < kFewBoards) {
      add(Severity::kNotice, "camera", fmt::format("only {} checkerboard photographs", camera->photos),
          "the lens is known where the board was seen, and guessed elsewhere",
          "take about 15, tilted differently, reaching into every corner of the picture");
    }
  }

  void judgeSurface() {
    if (!calibration_.surface || calibration_.projectors.empty()) return;
    double density = 0;
    for (const auto& p : summary_.projectors) density = std::max(density, p.density);
    const double error = calibration_.surface->rms * density;
    if (error <= kNoticeFiducial) return;
    add(above(error, kBadFiducial), "surface",
        fmt::format("the fiducials fit the wall to {:.2f} ", calibration_.surface->rms) + wall_.surface.wallUnits() +
            fmt::format(" only, {:.1f} projector pixels", error),
        "a marker's place was measured or typed wrongly, or the wall is not of the shape that wall.yaml says",
        "measure the markers' places again; the desktop is skewed by as much, seams are not affected");
  }

  void judgeSeam(const Seam& seam) {
    if (!seam.insideDisplay) return;
    const std::string where = seam.first + " and " + seam.second;
    if (seam.expectedRms > kNoticeSeam) {
      add(above(seam.expectedRms, kBadSeam), where,
          fmt::format("expected seam error {:.2f} px rms, {:.2f} px at worst: edges look doubled", seam.expectedRms,
                      seam.expectedWorst),
          "the two measurements disagree where both light the wall",
          "see which of the two has the longer arrows there, and measure that one again");
    }
    if (seam.sharedPercent < kMostlyShared) judgeBlend(seam, where);
    if (seam.densityRatio > kDensityRatio) {
      add(Severity::kNotice, where,
          fmt::format("one has {:.1f} times the other's pixels a length: sharpness changes across the seam",
                      seam.densityRatio),
          "different zoom or distance", "bring both to the same size; an inset by intention needs nothing");
    }
  }

  void judgeBlend(const Seam& seam, const std::string& where) {
    if (seam.overlapPercent >= kNarrowOverlap && seam.narrowest >= kNarrowBlend) return;
    add(Severity::kNotice, where,
        fmt::format("they overlap by {:.1f} %, the blend is {:.0f} desktop pixels wide at its narrowest",
                    seam.overlapPercent, seam.narrowest),
        "the projectors stand too far apart or are turned against each other",
        "aim for an overlap of 10 to 20 %, so that differences in brightness fade slowly");
  }

  void judgeDisplay() {
    judgeUnion();
    if (!calibration_.display || summary_.lit.area <= 0) return;
    const Display& d = *calibration_.display;
    const double share = (d.right - d.left) * (d.bottom - d.top) / summary_.lit.area;
    if (share < kLittleOfTheLit) {
      add(Severity::kNotice, "display", fmt::format("the desktop uses {:.0f} % of the lit area", 100 * share),
          "the lit area is ragged, falls apart, or has another shape than the aspect asked for",
          "level the projectors' edges, or set aspect: any under display in wall.yaml");
    }
    std::vector<Outline> outlines;
    for (const auto& p : summary_.projectors) {
      if (p.calibrated) outlines.push_back(p.outline);
    }
    if (!wall_.isFlat() && !isLit(d, outlines)) {
      add(Severity::kBad, "display", "part of the desktop is not lit",
          "a projector has moved, was left out, or is corrected by hand since the display was found",
          "find it again: pixelflex calibrate WALL mesh blend");
    }
  }

  void judgeUnion() {
    const auto lonely =
        std::ranges::count_if(summary_.projectors, [](const auto& p) { return p.calibrated && p.neighbours.empty(); });
    if (summary_.lit.islands.size() > 1 && !wall_.isFlat()) {
      add(Severity::kNotice, "wall", fmt::format("the lit area falls into {} parts", summary_.lit.islands.size()),
          lonely > 0 ? "a projector overlaps no other projector" : "two groups of projectors do not meet",
          "aim them so that neighbours overlap by 10 to 20 %; the desktop is on the part with the largest rectangle");
    }
    if (!summary_.lit.holes.empty()) {
      const std::size_t holes = summary_.lit.holes.size();
      add(Severity::kNotice, "wall", fmt::format("the lit area has {} hole{}", holes, holes == 1 ? "" : "s"),
          "no projector lights the wall there", "aim a projector at it; the desktop keeps clear of it meanwhile");
    }
  }

  void judgeStore() {
    if (!summary_.missingSteps.empty()) {
      add(Severity::kNotice, "wall", "not all is measured: no result of " + joined(summary_.missingSteps),
          "these steps have not run since what they depend on was measured", "run pixelflex calibrate WALL");
    }
    for (const auto& config : wall_.projectors) {
      const auto* projector = calibration_.find(config.name);
      if (projector == nullptr || projector->resolution == config.resolution) continue;
      add(Severity::kBad, config.name,
          fmt::format("measured at {}x{}, but wall.yaml says {}x{}", projector->resolution.width,
                      projector->resolution.height, config.resolution.width, config.resolution.height),
          "its resolution was changed after it was measured", "run pixelflex calibrate WALL --only " + config.name);
    }
  }

  const Wall& wall_;
  const Calibration& calibration_;
  const Summary& summary_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> judge(const Wall& wall, const Calibration& calibration, const Summary& summary) {
  return Judge(wall, calibration, summary).run();
}

SeamFigures seamFigures(const std::vector<Seam>& seams) {
  SeamFigures figures;
  double squares = 0;
  for (const auto& seam : seams) {
    if (!seam.insideDisplay) continue;
    ++figures.count;
    squares += seam.expectedRms * seam.expectedRms;
    if (seam.expectedWorst < figures.worst) continue;
    figures.worst = seam.expectedWorst;
    figures.worstAt = seam.first + " and " + seam.second;
  }
  if (figures.count > 0) figures.rms = std::sqrt(squares / figures.count);
  return figures;
}

std::string verdict(const Summary& summary, const std::vector<Finding>& findings) {
  const auto calibrated = std::ranges::count_if(summary.projectors, &ProjectorSummary::calibrated);
  const auto bad = std::ranges::count(findings, Severity::kBad, &Finding::severity);
  if (findings.empty()) {
    const SeamFigures seams = seamFigures(summary.seams);
    std::string good = fmt::format("Good: {} projector{} calibrated", static_cast<std::size_t>(calibrated),
                                   calibrated == 1 ? "" : "s");
    if (seams.count > 0)
      good += fmt::format(", seams expected to meet within {:.2f} px (rms)", std::max(0.01, seams.rms));
    return good + ".";
  }
  const Finding& first = findings.front();
  const std::string opening = bad > 0 ? "Not good yet: " : "Usable, but look at ";
  const std::size_t others = findings.size() - 1;
  const std::string rest = others == 0 ? "" : fmt::format(", and {} more", others);
  return opening + first.where + " (" + first.what + ")" + rest + ".";
}

}  // namespace pixelflex::calib
