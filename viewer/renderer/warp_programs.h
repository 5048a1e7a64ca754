#pragma once

#include <map>
#include <optional>
#include <string>

#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// What of the pipeline an output uses; each combination is a shader of its own, as software rasterisers execute both
/// sides of every branch.
struct WarpVariant {
  bool exact = false;
  bool measure = false;  // the sampled value itself: no light, mask, response or dither
  bool colour = false;
  bool mask = false;
  bool black = false;
  bool response = false;
  bool cursor = false;
  bool dither = false;
  bool tenBits = false;  // the frame has ten bits for each colour
  DesktopTransfer transfer = DesktopTransfer::kSrgb;
  Filter filter = Filter::kCatmullRom;
  bool filterLight = false;  // texels are decoded before they are filtered
  auto operator<=>(const WarpVariant&) const = default;
};

/// Shaders compiled when first asked for, and the noise that they dither with. Needs its context current.
class WarpPrograms {
 public:
  [[nodiscard]] const devices::GlProgram& get(const WarpVariant& variant);
  /// shaders/overlay.frag, over the whole viewport.
  [[nodiscard]] const devices::GlProgram& overlay();
  /// GL_TEXTURE_2D of makeDitherTile().
  [[nodiscard]] devices::GlName ditherTile();

 private:
  devices::GlTexture ditherTile_;
  std::optional<devices::GlProgram> overlay_;
  std::map<WarpVariant, devices::GlProgram> programs_;
};

}  // namespace pixelflex::viewer
