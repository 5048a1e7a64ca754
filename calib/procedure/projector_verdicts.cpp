#include "calib/procedure/projector_verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calib/patterns/blob_pattern.h"

namespace pixelflex::calib {
namespace {

// Where good ends. Errors in projector pixels.
constexpr double kNoticeBlobs = 0.90, kBadBlobs = 0.75;  // of those shown
constexpr double kNoticeRms = 0.25, kBadRms = 0.6;
constexpr double kOutlier = 6, kOutlierFloor = 0.5;           // times the rms, and at least this
constexpr double kHeldOutFactor = 1.5, kHeldOutFloor = 0.03;  // over the rms
constexpr double kSmallestBlobSigma = 1.5;                    // camera pixels
constexpr double kSoft = 0.85;  // projector pixels per desktop pixel; the mean rule alone leaves some below 1

class ProjectorJudge {
 public:
  explicit ProjectorJudge(const Calibration& calibration) : calibration_(calibration) {}

  std::vector<Finding> run(const ProjectorSummary& p) {
    if (!p.calibrated) {
      add(Severity::kBad, p.name, "not calibrated: shows nothing of the desktop",
          "nothing was photographed of it, it was skipped, or it was not recognised",
          "switch it on and measure it alone: pixelflex calibrate WALL --only " + p.name);
      return std::move(findings_);
    }
    judgeBlobs(p);
    judgeFit(p);
    judgeCameraScale(p);
    judgeUse(p);
    judgeNudge(p.name);
    return std::move(findings_);
  }

 private:
  void add(Severity severity, std::string where, std::string what, std::string cause, std::string cure) {
    findings_.push_back({severity, std::move(where), std::move(what), std::move(cause), std::move(cure)});
  }

  void judgeBlobs(const ProjectorSummary& p) {
    const auto& q = p.quality;
    const double share = q.shown > 0 ? static_cast<double>(q.found) / q.shown : 1;
    if (share >= kNoticeBlobs) return;
    add(share < kBadBlobs ? Severity::kBad : Severity::kNotice, p.name,
        fmt::format("{} of {} points found ({:.0f} %)", q.found, q.shown, 100 * share),
        "something stood between projector, wall and camera, or part of the frame misses the wall or the picture",
        "look where the crosses are in its photograph, clear the view, and measure it again: pixelflex calibrate WALL "
        "--only " +
            p.name);
  }

  void judgeFit(const ProjectorSummary& p) {
    const auto& q = p.quality;
    if (q.rms > kNoticeRms) {
      add(q.rms > kBadRms ? Severity::kBad : Severity::kNotice, p.name,
          fmt::format("the model leaves {:.2f} px rms of its points", q.rms),
          "blurred or noisy photographs, a camera that moved between them, or a wall that is not as flat as declared",
          "look at the arrows: all alike in one part means the wall or the camera, at random means the photographs");
    }
    if (q.maximum > std::max(kOutlierFloor, kOutlier * q.rms)) {
      add(Severity::kNotice, p.name,
          fmt::format("one point is {:.2f} px off, the rest {:.2f} px rms", q.maximum, q.rms),
          "a reflection, a cable or an edge of the wall within a blob", "see where the longest arrow stands");
    }
    if (q.heldOut > kHeldOutFactor * q.rms + kHeldOutFloor) {
      add(Severity::kNotice, p.name,
          fmt::format("points left out of the fit are missed by {:.2f} px rms, fitted ones by {:.2f} px", q.heldOut,
                      q.rms),
          "too few points, or a large gap among them: the model bends between the points",
          "get more of its points into the picture, or measure with --method dense");
    }
  }

  void judgeCameraScale(const ProjectorSummary& p) {
    const auto* projector = calibration_.find(p.name);
    if (projector == nullptr || p.quality.cameraScale <= 0 || p.quality.shown > kBlobCount) return;
    const double sigma = p.quality.cameraScale * BlobLayout(projector->resolution).sigma();
    if (sigma >= kSmallestBlobSigma) return;
    add(Severity::kNotice, p.name,
        fmt::format("the camera sees it coarsely: {:.2f} camera pixels a projector pixel, blobs of {:.1f} px",
                    p.quality.cameraScale, sigma),
        "the camera is far away, zoomed out, or of low resolution",
        "go nearer, photograph from several places, or measure with --method dense");
  }

  void judgeUse(const ProjectorSummary& p) {
    if (!calibration_.display) return;
    if (p.displayPercent <= 0) {
      add(Severity::kBad, p.name, "outside the display: shows nothing of the desktop",
          "the largest rectangle within the lit area leaves it out",
          "aim it at the others' rectangle, or set another aspect under display in wall.yaml");
    } else if (p.desktopDensity < kSoft) {
      add(Severity::kNotice, p.name,
          fmt::format("{:.2f} projector pixels a desktop pixel: small text is soft there", p.desktopDensity),
          "it spreads its pixels over more wall than the others do",
          "bring it nearer or zoom it in, or set desktop: oversampling: 1.25 in wall.yaml");
    }
  }

  void judgeNudge(const std::string& name) {
    const auto* projector = calibration_.find(name);
    if (projector == nullptr || !projector->nudge || *projector->nudge == Nudge{}) return;
    const Nudge& nudge = *projector->nudge;
    add(Severity::kNotice, name,
        fmt::format("corrected by hand: {:+.2f}, {:+.2f} px, roll {:+.2f} degrees", nudge.shift.x, nudge.shift.y,
                    nudge.roll),
        "nudge.yaml holds a correction that stays through calibrations",
        "after a new measurement it is rarely needed: pixelflex calibrate WALL --clear-nudge " + name);
  }

  const Calibration& calibration_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> judgeProjector(const Calibration& calibration, const ProjectorSummary& projector) {
  return ProjectorJudge(calibration).run(projector);
}

}  // namespace pixelflex::calib
