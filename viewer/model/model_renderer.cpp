#include "viewer/model/model_renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "shader_sources.h"
#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

/// The scene's light has a unit of its own beside the warp's.
constexpr GLuint kSceneUnit = 8;
constexpr GLuint kLensUnit = 9;
constexpr int kClipDistances = 7;

std::string lightDefinitions(const WarpVariant& variant) {
  return fmt::format(
      "#define COLOUR {:d}\n#define BLACK {:d}\n#define RESPONSE {:d}\n#define DITHER {:d}\n#define LINEAR_DESKTOP "
      "{:d}\n"
      "#define TEN_BITS 0\n",
      variant.colour, variant.black, variant.response, variant.dither, variant.transfer == DesktopTransfer::kLinear);
}

/// Shaders that only decode sRGB.
constexpr const char* kPlainLight =
    "#define RESPONSE 0\n#define DITHER 0\n#define LINEAR_DESKTOP 0\n#define TEN_BITS 0\n";

devices::GlTexture lensTexture(const LensLattice& lens) {
  auto texture = makeTexture(GL_RG32F, {lens.columns, lens.rows});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture.get(), 0, 0, 0, lens.columns, lens.rows, GL_RG, GL_FLOAT, lens.shifts.data());
  return texture;
}

void checkResolution(const OutputPlan& plan) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const auto [width, height] = plan.resolution;
  if (width > 0 && height > 0 && width <= largest && height <= largest) return;
  throw RendererError(
      fmt::format("output '{}' of {}x{} pixels: must be 1 to {} each way", plan.name, width, height, largest));
}

/// State that others may have left.
void prepareState(bool wireframe) {
  for (const GLenum off : {GL_DITHER, GL_BLEND, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB, GL_SCISSOR_TEST}) glDisable(off);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, wireframe ? GL_LINE : GL_FILL);
}

void restoreState() {
  glDisable(GL_DEPTH_TEST);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  for (unsigned i = 0; i < kClipDistances; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
}

}  // namespace

ModelRenderer::ModelRenderer(devices::GlContext& context, const std::vector<ModelOutput>& outputs, ModelOptions options)
    : context_(context), options_(options) {
  context_.makeCurrent();
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  samples_ = options_.measure ? 1 : std::clamp(options_.samples, 1, std::max(most, 1));
  noVertices_ = devices::GlVertexArray::create();
  for (const auto& output : outputs) frames_.push_back(makeFrame(output));
}

ModelRenderer::~ModelRenderer() {
  try {
    context_.makeCurrent();
  } catch (const devices::DisplayError&) {
    // The context is gone and its objects with it; deleting their names is then without effect.
    return;
  }
}

ModelRenderer::Frame ModelRenderer::makeFrame(const ModelOutput& output) const {
  checkResolution(output.light);
  Frame frame{.output = output, .light = OutputLight(output.light)};
  frame.light.addTo(frame.variant);
  frame.variant.dither = output.light.dither;
  frame.variant.transfer = output.light.transfer;
  if (!output.lens.empty()) frame.lens = lensTexture(output.lens);
  frame.frame = makeTexture(options_.measure ? GL_RGBA32F : GL_RGBA8, output.light.resolution);
  frame.target = drawingTarget(frame.frame.get(), 0, "output '" + output.light.name + "'");
  // The light is on the GPU now.
  frame.output.light.alpha = frame.output.light.gain = frame.output.light.black = {};
  return frame;
}

void ModelRenderer::setScene(Scene scene) {
  context_.makeCurrent();
  scene_.reset();  // first, so that two scenes never exist at once
  scene_.emplace(std::move(scene));
  bounds_ = scene_->bounds();
  axes_.emplace(axesScene(bounds_.empty() ? 1 : 0.6F * glm::length(bounds_.high - bounds_.low)));
  stale_ = true;
}

void ModelRenderer::setView(const ModelView& view) {
  view_ = view;
  stale_ = true;
}

const ModelCanvas& ModelRenderer::canvasOf(devices::Size size) {
  const auto found = canvases_.find({size.width, size.height});
  if (found != canvases_.end()) return found->second;
  return canvases_.emplace(std::pair(size.width, size.height), ModelCanvas(size, samples_, options_.measure))
      .first->second;
}

const devices::GlProgram& ModelRenderer::program(const std::string& name, const std::string& definitions) {
  const auto found = programs_.find(name + definitions);
  if (found != programs_.end()) return found->second;
  using devices::ShaderPieces;
  ShaderPieces vertex{definitions, shaders::kNearVert};
  ShaderPieces fragment{definitions, shaders::kMaskFrag};
  if (name == "lookup") fragment = {definitions, shaders::kLightGlsl, shaders::kLookupFrag};
  if (name == "model") {
    vertex = {definitions, shaders::kModelVert};
    fragment = {definitions, shaders::kLightGlsl, shaders::kModelFrag};
  }
  return programs_.emplace(name + definitions, devices::GlProgram(name, vertex, fragment)).first->second;
}

void ModelRenderer::draw() {
  if (!stale_) return;
  context_.makeCurrent();
  for (auto& frame : frames_) drawFrame(frame);
  restoreState();
  glFinish();  // another context may show the frames next
  stale_ = false;
}

void ModelRenderer::drawFrame(Frame& frame) {
  const ModelCanvas& canvas = canvasOf(frame.output.light.resolution);
  const auto [width, height] = frame.output.light.resolution;
  glViewport(0, 0, width, height);
  prepareState(view_.wireframe);
  drawScene(frame, canvas);
  restoreState();
  canvas.resolve();
  if (options_.measure) {
    glCopyImageSubData(canvas.light(), GL_TEXTURE_2D, 0, 0, 0, 0, frame.frame.get(), GL_TEXTURE_2D, 0, 0, 0, 0, width,
                       height, 1);
    return;
  }
  glBindVertexArray(noVertices_.get());
  frame.light.bind();
  glBindFramebuffer(GL_FRAMEBUFFER, canvas.lightTarget());
  const bool dark = frame.drawn.parts == 0 && !view_.axes;
  if (frame.variant.mask && options_.correct && !dark) drawMask(frame);
  lookUp(frame, canvas);
}

void ModelRenderer::drawScene(Frame& frame, const ModelCanvas& canvas) {
  glBindFramebuffer(GL_FRAMEBUFFER, canvas.sampleTarget());
  constexpr GLfloat kBlack[] = {0, 0, 0, 0};
  constexpr GLfloat kFar = 1;
  glClearBufferfv(GL_COLOR, 0, kBlack);
  glClearBufferfv(GL_DEPTH, 0, &kFar);
  frame.drawn = {};
  if (!scene_) return;
  const glm::dmat4 inWindow = windowFromModel(view_.pose, bounds_, view_.window);
  const glm::dvec3 middle(inWindow * glm::dvec4(bounds_.middle(), 1));
  const double radius = radiusInWindow(view_.pose, bounds_, view_.window) * (view_.axes ? 1.3 : 1.0);
  const glm::dmat4 onDesktop =
      desktopFromWindow(view_.window, eyeOf(view_.viewer, frame.output.eye), middle, radius) * inWindow;
  // What does not reach over the display's borders need not be held to them.
  const bool clip = options_.correct && (view_.axes || !isInside(bounds_, onDesktop));
  const auto& drawing = useModelProgram(frame, clip);
  setMatrices(drawing, frame, onDesktop);
  frame.drawn = options_.cull ? scene_->draw(drawing, onDesktop, frame.output.projectorFromDesktop * onDesktop)
                              : scene_->drawAll(drawing);
  if (view_.axes) axes_->drawAll(drawing);
}

const devices::GlProgram& ModelRenderer::useModelProgram(const Frame& frame, bool clip) {
  for (unsigned i = 0; i < 6; ++i) (clip ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + i);
  (view_.cut ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + 6);
  const auto& drawing = program(
      "model", fmt::format("#define LENS {:d}\n#define CLIP {:d}\n#define CUT {:d}\n#define MEASURE {:d}\n{}",
                           static_cast<bool>(frame.lens), clip, view_.cut.has_value(), options_.measure, kPlainLight));
  drawing.use();
  return drawing;
}

void ModelRenderer::setMatrices(const devices::GlProgram& drawing, const Frame& frame,
                                const glm::dmat4& desktopFromModel) const {
  const glm::dmat4 inWindow = windowFromModel(view_.pose, bounds_, view_.window);
  drawing.set("desktopFromModel", glm::mat4(desktopFromModel));
  drawing.set("projectorFromDesktop", glm::mat4(frame.output.projectorFromDesktop));
  drawing.set("windowFromModel", glm::mat4(inWindow));
  drawing.set("eye", glm::vec3(eyeOf(view_.viewer, frame.output.eye)));
  if (view_.cut) drawing.set("cut", glm::vec4(glm::transpose(inWindow) * *view_.cut));
  drawing.set("picture", 0);
  drawing.set("lens", static_cast<int>(kLensUnit));
  drawing.set("lensReach", static_cast<float>(1 + 2 * kLensMargin));
  glBindTextureUnit(kLensUnit, frame.lens.get());
}

void ModelRenderer::drawMask(const Frame& frame) {
  const auto& mask = program("mask", "");
  mask.use();
  frame.light.setUniforms(mask);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
}

void ModelRenderer::lookUp(const Frame& frame, const ModelCanvas& canvas) {
  const auto& table = program("lookup", lightDefinitions(frame.variant));
  table.use();
  frame.light.setUniforms(table);
  table.set("scene", static_cast<int>(kSceneUnit));
  table.set("noise", static_cast<int>(kNoiseUnit));
  table.set("highestCode", 255.0F);
  if (frame.variant.dither) glBindTextureUnit(kNoiseUnit, noise_.ditherTile());
  glBindTextureUnit(kSceneUnit, canvas.light());
  glBindFramebuffer(GL_FRAMEBUFFER, frame.target.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

devices::Size ModelRenderer::outputResolution(std::size_t output) const {
  return frames_.at(output).output.light.resolution;
}

devices::Image8 ModelRenderer::readOutput(std::size_t output) {
  context_.makeCurrent();
  devices::Image8 image(outputResolution(output), 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(outputTexture(output), 0, GL_RGB, GL_UNSIGNED_BYTE,
                    static_cast<GLsizei>(image.samples().size_bytes()), image.samples().data());
  return image;
}

devices::ImageF ModelRenderer::readOutputFloat(std::size_t output) {
  context_.makeCurrent();
  devices::ImageF image(outputResolution(output), 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(outputTexture(output), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.samples().size_bytes()),
                    image.samples().data());
  return image;
}

}  // namespace pixelflex::viewer
