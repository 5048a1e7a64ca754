#pragma once

#include <string>
#include <vector>

#include "calib/procedure/summary.h"

namespace pixelflex::calib {

enum class Severity {
  kNotice,  // works, but could be better or should be known
  kBad,     // will be seen by the audience
};

/// Something about a calibration that is not good, in words for a person.
struct Finding {
  Severity severity = Severity::kNotice;
  std::string where;  // "p3", "p1 and p2", "camera", "surface", "display", "wall"
  std::string what;   // what was seen, with figures
  std::string cause;  // what it probably comes from
  std::string cure;   // what to do
  bool operator==(const Finding&) const = default;
};

/// All that is not good, the bad ones first, otherwise in the order camera, surface, projectors, seams, display.
[[nodiscard]] std::vector<Finding> judge(const Wall& wall, const Calibration& calibration, const Summary& summary);

/// The whole in one sentence: "Good: …", "Usable, but …" or "Not good yet: …".
[[nodiscard]] std::string verdict(const Summary& summary, const std::vector<Finding>& findings);

/// The seams' figures over the whole display: root mean square of the expected errors, and the worst.
struct SeamFigures {
  int count = 0;
  double rms = 0;
  double worst = 0;
  std::string worstAt;  // "p1 and p2"
};
[[nodiscard]] SeamFigures seamFigures(const std::vector<Seam>& seams);

}  // namespace pixelflex::calib
