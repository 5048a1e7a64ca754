#pragma once

#include <map>
#include <string>

#include "devices/display/gl_program.h"
#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// What of the pipeline an output uses; each combination is a shader of its own, as software rasterisers execute both
/// sides of every branch.
struct WarpVariant {
  bool exact = false;
  bool measure = false;  // the sampled value itself: no light, mask, response or dither
  bool mask = false;
  bool response = false;
  bool cursor = false;
  bool dither = false;
  DesktopTransfer transfer = DesktopTransfer::kSrgb;
  Filter filter = Filter::kCatmullRom;
};

/// Shaders compiled when first asked for. Needs its context current.
class WarpPrograms {
 public:
  [[nodiscard]] const devices::GlProgram& get(const WarpVariant& variant);

 private:
  std::map<std::string, devices::GlProgram> programs_;  // by the definitions in front
};

}  // namespace pixelflex::viewer
