#pragma once

#include <glm/mat4x4.hpp>

#include "devices/display/gl_handle.h"
#include "viewer/model/model_canvas.h"
#include "viewer/model/model_shaders.h"
#include "viewer/model/model_view.h"
#include "viewer/model/one_pass.h"
#include "viewer/model/scene_buffers.h"
#include "viewer/renderer/output_light.h"
#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// One frame that a scene is drawn into: a projector's, or the whole desktop's.
struct ModelOutput {
  OutputPlan light;                    // name, resolution and light; mesh and desktop are not used
  glm::dmat4 projectorFromDesktop{1};  // clip coordinates, see depthKeeping()
  LensLattice lens;                    // corrected at the vertices; empty: not
  Eye eye = Eye::kMiddle;
};

/// The same in graphics memory. Needs its context current.
class ModelFrame {
 public:
  /// `measure`: as ModelOptions. Throws RendererError when the output is not sound.
  ModelFrame(const ModelOutput& output, bool measure);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] devices::Size size() const { return size_; }
  [[nodiscard]] Eye eye() const { return eye_; }
  [[nodiscard]] const glm::dmat4& projectorFromDesktop() const { return projectorFromDesktop_; }
  [[nodiscard]] bool bent() const { return static_cast<bool>(lens_); }
  /// For programs of a variant with the lens.
  void setLens(const devices::GlProgram& program) const;

  /// Everything after the scene: the mask, unless the frame is `plain`, and the look-up. `dither`: GL_TEXTURE_2D.
  void finish(const ModelCanvas& canvas, ModelShaders& shaders, devices::GlName dither, bool plain) const;
  /// Instead, of measurements: the scene as it is.
  void copy(const ModelCanvas& canvas) const;

  /// GL_TEXTURE_2D, row 0 at the top of the picture.
  [[nodiscard]] devices::GlName texture() const { return frame_.get(); }

  DrawnParts drawn;  // by the last draw

 private:
  std::string name_;
  devices::Size size_;
  Eye eye_;
  glm::dmat4 projectorFromDesktop_;
  OutputLight light_;
  WarpVariant variant_;
  devices::GlTexture lens_;
  devices::GlTexture frame_;
  devices::GlFramebuffer target_;
};

}  // namespace pixelflex::viewer
