#pragma once

#include <map>
#include <string>

#include "devices/display/gl_program.h"
#include "viewer/model/scene.h"
#include "viewer/renderer/warp_programs.h"

namespace pixelflex::viewer {

/// What of shaders/model.* a drawing uses; each combination is a shader of its own, as for WarpVariant.
struct ModelVariant {
  bool lens = false;
  bool clip = false;  // held to the display's borders
  bool cut = false;   // by ModelView::cut
  bool measure = false;
  bool lit = true;
  bool shiny = false;
  bool picture = false;
  bool cutoff = false;
  bool blend = false;
  auto operator<=>(const ModelVariant&) const = default;
};

/// Shaders compiled when first asked for. Needs its context current.
class ModelShaders {
 public:
  [[nodiscard]] const devices::GlProgram& model(const ModelVariant& variant);
  /// Over the whole frame after the scene.
  [[nodiscard]] const devices::GlProgram& lookUp(const WarpVariant& variant);

 private:
  std::map<ModelVariant, devices::GlProgram> models_;
  std::map<WarpVariant, devices::GlProgram> lookUps_;
};

}  // namespace pixelflex::viewer
