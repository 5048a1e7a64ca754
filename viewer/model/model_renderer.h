#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/model/model_canvas.h"
#include "viewer/model/model_frame.h"
#include "viewer/model/model_shaders.h"
#include "viewer/model/model_view.h"
#include "viewer/model/scene_buffers.h"
#include "viewer/renderer/warp_programs.h"

namespace pixelflex::viewer {

struct ModelOptions {
  int samples = 4;       // of a pixel, at most; 1: edges are not smoothed
  bool measure = false;  // frames in RGBA32F: the place in the model that each pixel shows, alpha 1 where it is
  bool cull = true;      // parts that a projector does not see are left out
  bool correct = true;   // false, for comparison: neither held to the display nor masked
};

/// Draws a scene for every projector in one pass each: matrix stack, then mask and look-up at the near plane. One
/// thread, the context's. Each function makes the context current.
class ModelRenderer {
 public:
  /// The context must outlive the renderer. Throws RendererError when an output is not sound.
  ModelRenderer(devices::GlContext& context, const std::vector<ModelOutput>& outputs, ModelOptions options = {});
  ~ModelRenderer();
  ModelRenderer(const ModelRenderer&) = delete;
  ModelRenderer& operator=(const ModelRenderer&) = delete;

  /// Other frames for the same scene; all is drawn again. Throws RendererError, and then keeps the old ones.
  void setOutputs(const std::vector<ModelOutput>& outputs);
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
  [[nodiscard]] const std::string& outputName(std::size_t output) const { return frames_.at(output).name(); }
  [[nodiscard]] devices::Size outputResolution(std::size_t output) const { return frames_.at(output).size(); }
  /// What the last draw sent for it.
  [[nodiscard]] DrawnParts drawnParts(std::size_t output) const { return frames_.at(output).drawn; }
  /// GL_TEXTURE_2D, row 0 at the top of the picture.
  [[nodiscard]] devices::GlName outputTexture(std::size_t output) const { return frames_.at(output).texture(); }
  /// Red, green, blue.
  [[nodiscard]] devices::Image8 readOutput(std::size_t output);
  /// Four channels.
  [[nodiscard]] devices::ImageF readOutputFloat(std::size_t output);

 private:
  const ModelCanvas& canvasOf(devices::Size size);
  void drawFrame(ModelFrame& frame);
  void drawScene(ModelFrame& frame);
  [[nodiscard]] SceneSight sightOf(const ModelFrame& frame) const;
  /// Of a scene, ours or the axes, what a group of it is drawn by.
  void useFor(const ModelFrame& frame, const SceneBuffers& scene, const SceneGroup& group, const SceneSight& sight,
              bool blend);
  void setMatrices(const devices::GlProgram& program, const ModelFrame& frame, const SceneSight& sight) const;

  devices::GlContext& context_;
  ModelOptions options_;
  int samples_ = 1;
  WarpPrograms noise_;
  ModelShaders shaders_;
  std::map<std::pair<int, int>, ModelCanvas> canvases_;  // by width and height
  std::vector<ModelFrame> frames_;
  std::optional<SceneBuffers> scene_;
  std::optional<SceneBuffers> axes_;
  Bounds3 bounds_;
  ModelView view_;
  devices::GlVertexArray noVertices_;
  bool stale_ = true;
};

}  // namespace pixelflex::viewer
