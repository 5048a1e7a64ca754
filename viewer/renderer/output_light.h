#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/renderer/warp_programs.h"

namespace pixelflex::viewer {

/// What makes of the desktop's light one projector's codes, on the GPU: matrix, mask, gain, black and response. Needs
/// its context current.
class OutputLight {
 public:
  OutputLight() = default;
  /// Throws RendererError when a part of the plan is not sound.
  explicit OutputLight(const OutputPlan& plan);

  /// What the plan does not have costs nothing.
  void addTo(WarpVariant& variant) const;
  void bind() const;
  void setUniforms(const devices::GlProgram& program) const;

 private:
  void makeMap(const OutputPlan& plan);
  void makeResponse(const OutputPlan& plan);

  glm::mat3 colour_{1};
  glm::vec3 largestBlack_{0};
  bool masked_ = false;
  bool lifted_ = false;
  devices::GlTexture map_;  // mask times gain, and black: one fetch for all
  devices::GlBuffer responseEntries_;
  devices::GlTexture response_;
};

}  // namespace pixelflex::viewer
