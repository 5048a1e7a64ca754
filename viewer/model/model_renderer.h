#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/model/model_canvas.h"
#include "viewer/model/model_view.h"
#include "viewer/model/one_pass.h"
#include "viewer/model/scene_buffers.h"
#include "viewer/renderer/output_light.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/renderer/warp_programs.h"

namespace pixelflex::viewer {

/// One frame that a scene is drawn into: a projector's, or the whole desktop's.
struct ModelOutput {
  OutputPlan light;                    // name, resolution and light; mesh and desktop are not used
  glm::dmat4 projectorFromDesktop{1};  // clip coordinates, see depthKeeping()
  LensLattice lens;                    // corrected at the vertices; empty: not
  Eye eye = Eye::kMiddle;
};

struct ModelOptions {
  int samples = 4;       // of a pixel, at most; 1: edges are not smoothed
  bool measure = false;  // frames in RGBA32F: the place in the model that each pixel shows, alpha 1 where it is
  bool cull = true;      // parts that a projector does not see are left out
  bool correct = true;   // false, for comparison: neither held to the display nor masked
};

/// Draws a scene for every projector in one pass each: matrix stack, mask at the near plane, look-up. One thread, the
/// context's. Each function makes the context current.
class ModelRenderer {
 public:
  /// The context must outlive the renderer. Throws RendererError when an output is not sound.
  ModelRenderer(devices::GlContext& context, const std::vector<ModelOutput>& outputs, ModelOptions options = {});
  ~ModelRenderer();
  ModelRenderer(const ModelRenderer&) = delete;
  ModelRenderer& operator=(const ModelRenderer&) = delete;

  /// Keeps no copy outside the graphics memory. Throws RendererError.
  void setScene(Scene scene);
  [[nodiscard]] const Bounds3& bounds() const { return bounds_; }
  /// Of vertices and indices in graphics memory.
  [[nodiscard]] std::size_t sceneBytes() const { return scene_ ? scene_->bytes() : 0; }
  /// Everything is drawn again.
  void setView(const ModelView& view);

  [[nodiscard]] bool needsDraw() const { return stale_; }
  /// Draws all outputs and waits until they are drawn; nothing, when neither scene nor view has changed.
  void draw();

  [[nodiscard]] std::size_t outputCount() const { return frames_.size(); }
  [[nodiscard]] const std::string& outputName(std::size_t output) const { return frames_.at(output).output.light.name; }
  [[nodiscard]] devices::Size outputResolution(std::size_t output) const;
  /// What the last draw sent for it.
  [[nodiscard]] DrawnParts drawnParts(std::size_t output) const { return frames_.at(output).drawn; }
  /// GL_TEXTURE_2D, row 0 at the top of the picture.
  [[nodiscard]] devices::GlName outputTexture(std::size_t output) const { return frames_.at(output).frame.get(); }
  /// Red, green, blue.
  [[nodiscard]] devices::Image8 readOutput(std::size_t output);
  /// Four channels.
  [[nodiscard]] devices::ImageF readOutputFloat(std::size_t output);

 private:
  struct Frame {
    ModelOutput output;
    OutputLight light;
    WarpVariant variant;
    devices::GlTexture lens;
    devices::GlTexture frame;
    devices::GlFramebuffer target;
    DrawnParts drawn;
  };
  [[nodiscard]] Frame makeFrame(const ModelOutput& output) const;
  const ModelCanvas& canvasOf(devices::Size size);
  const devices::GlProgram& program(const std::string& name, const std::string& definitions);
  void drawFrame(Frame& frame);
  void drawScene(Frame& frame, const ModelCanvas& canvas);
  const devices::GlProgram& useModelProgram(const Frame& frame, bool clip);
  void setMatrices(const devices::GlProgram& program, const Frame& frame, const glm::dmat4& desktopFromModel) const;
  void drawMask(const Frame& frame);
  void lookUp(const Frame& frame, const ModelCanvas& canvas);

  devices::GlContext& context_;
  ModelOptions options_;
  int samples_ = 1;
  WarpPrograms noise_;
  std::map<std::string, devices::GlProgram> programs_;   // by name and definitions
  std::map<std::pair<int, int>, ModelCanvas> canvases_;  // by width and height
  std::vector<Frame> frames_;
  std::optional<SceneBuffers> scene_;
  std::optional<SceneBuffers> axes_;
  Bounds3 bounds_;
  ModelView view_;
  devices::GlVertexArray noVertices_;
  bool stale_ = true;
};

}  // namespace pixelflex::viewer
