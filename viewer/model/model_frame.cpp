#include "viewer/model/model_frame.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "viewer/renderer/dither_tile.h"
#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

/// Units of their own beside the warp's.
constexpr GLuint kSceneUnit = 8;
constexpr GLuint kLensUnit = 9;

devices::GlTexture lensTexture(const LensLattice& lens) {
  if (lens.empty()) return {};
  auto texture = makeTexture(GL_RG32F, {lens.columns, lens.rows});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture.get(), 0, 0, 0, lens.columns, lens.rows, GL_RG, GL_FLOAT, lens.shifts.data());
  return texture;
}

const OutputPlan& checked(const OutputPlan& plan) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const auto [width, height] = plan.resolution;
  if (width > 0 && height > 0 && width <= largest && height <= largest) return plan;
  throw RendererError(
      fmt::format("output '{}' of {}x{} pixels: must be 1 to {} each way", plan.name, width, height, largest));
}

}  // namespace

ModelFrame::ModelFrame(const ModelOutput& output, bool measure)
    : name_(output.light.name),
      size_(output.light.resolution),
      eye_(output.eye),
      projectorFromDesktop_(output.projectorFromDesktop),
      light_(checked(output.light)),
      lens_(lensTexture(output.lens)),
      frame_(makeTexture(measure ? GL_RGBA32F : GL_RGBA8, size_)),
      target_(drawingTarget(frame_.get(), 0, "output '" + name_ + "'")) {
  light_.addTo(variant_);
  variant_.dither = output.light.dither;
  variant_.transfer = output.light.transfer;
}

void ModelFrame::setLens(const devices::GlProgram& program) const {
  program.set("lens", static_cast<int>(kLensUnit));
  program.set("lensReach", static_cast<float>(1 + 2 * kLensMargin));
  glBindTextureUnit(kLensUnit, lens_.get());
}

void ModelFrame::finish(const ModelCanvas& canvas, ModelShaders& shaders, devices::GlName dither, bool plain) const {
  WarpVariant variant = variant_;
  variant.mask = variant.mask && !plain;
  const auto& table = shaders.lookUp(variant);
  table.use();
  light_.bind();
  light_.setUniforms(table);
  table.set("scene", static_cast<int>(kSceneUnit));
  table.set("noise", static_cast<int>(kNoiseUnit));
  table.set("noiseMask", kDitherExtent - 1);
  table.set("highestCode", 255.0F);
  glBindTextureUnit(kNoiseUnit, dither);
  glBindTextureUnit(kSceneUnit, canvas.light());
  glBindFramebuffer(GL_FRAMEBUFFER, target_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void ModelFrame::copy(const ModelCanvas& canvas) const {
  glCopyImageSubData(canvas.light(), GL_TEXTURE_2D, 0, 0, 0, 0, frame_.get(), GL_TEXTURE_2D, 0, 0, 0, 0, size_.width,
                     size_.height, 1);
}

}  // namespace pixelflex::viewer
