#include "viewer/model/model_renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pixelflex::viewer {
namespace {

constexpr int kClipDistances = 7;

/// State that others may have left.
void prepareState(bool wireframe) {
  for (const GLenum off : {GL_DITHER, GL_BLEND, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB, GL_SCISSOR_TEST}) glDisable(off);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, wireframe ? GL_LINE : GL_FILL);
}

void restoreState() {
  for (const GLenum off : {GL_DEPTH_TEST, GL_BLEND}) glDisable(off);
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
  setOutputs(outputs);
}

ModelRenderer::~ModelRenderer() {
  try {
    context_.makeCurrent();
  } catch (const devices::DisplayError&) {
    // The context is gone and its objects with it; deleting their names is then without effect.
    return;
  }
}

void ModelRenderer::setOutputs(const std::vector<ModelOutput>& outputs) {
  context_.makeCurrent();
  std::vector<ModelFrame> frames;
  for (const auto& output : outputs) frames.emplace_back(output, options_.measure);
  frames_ = std::move(frames);
  canvases_.clear();
  stale_ = true;
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

void ModelRenderer::draw() {
  if (!stale_) return;
  context_.makeCurrent();
  for (auto& frame : frames_) drawFrame(frame);
  restoreState();
  glFinish();  // another context may show the frames next
  stale_ = false;
}

void ModelRenderer::drawFrame(ModelFrame& frame) {
  const ModelCanvas& canvas = canvasOf(frame.size());
  glViewport(0, 0, frame.size().width, frame.size().height);
  glBindFramebuffer(GL_FRAMEBUFFER, canvas.sampleTarget());
  prepareState(view_.wireframe);
  constexpr GLfloat kBlack[] = {0, 0, 0, 0};
  constexpr GLfloat kFar = 1;
  glClearBufferfv(GL_COLOR, 0, kBlack);
  glClearBufferfv(GL_DEPTH, 0, &kFar);
  frame.drawn = {};
  if (scene_) drawScene(frame);
  restoreState();
  canvas.resolve();
  if (options_.measure) {
    frame.copy(canvas);
    return;
  }
  glBindVertexArray(noVertices_.get());
  const bool dark = frame.drawn.parts == 0 && !view_.axes;
  frame.finish(canvas, shaders_, noise_.ditherTile(), dark || !options_.correct);
}

void ModelRenderer::drawScene(ModelFrame& frame) {
  const SceneSight sight = sightOf(frame);
  for (const auto& group : scene_->solidGroups(sight)) {
    useFor(frame, *scene_, group, sight, false);
    scene_->drawSolid(group);
    frame.drawn.parts += group.drawn.parts;
    frame.drawn.triangles += group.drawn.triangles;
  }
  if (view_.axes) {
    for (const auto& group : axes_->solidGroups(sight)) {
      useFor(frame, *axes_, group, sight, false);
      axes_->drawSolid(group);
    }
  }
  if (sight.solid) return;
  const glm::dmat4 modelFromWindow = glm::inverse(windowFromModel(view_.pose, bounds_, view_.window));
  const glm::dvec3 eye(modelFromWindow * glm::dvec4(eyeOf(view_.viewer, frame.eye()), 1));
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (const auto& group : scene_->clearGroups(sight, eye)) {
    useFor(frame, *scene_, group, sight, true);
    scene_->drawClear(group);
    frame.drawn.parts += group.drawn.parts;
    frame.drawn.triangles += group.drawn.triangles;
  }
}

SceneSight ModelRenderer::sightOf(const ModelFrame& frame) const {
  const glm::dmat4 inWindow = windowFromModel(view_.pose, bounds_, view_.window);
  const glm::dvec3 middle(inWindow * glm::dvec4(bounds_.middle(), 1));
  const double radius = radiusInWindow(view_.pose, bounds_, view_.window) * (view_.axes ? 1.3 : 1.0);
  const glm::dmat4 onDesktop =
      desktopFromWindow(view_.window, eyeOf(view_.viewer, frame.eye()), middle, radius) * inWindow;
  return {.desktopFromModel = onDesktop,
          .projectorFromModel = frame.projectorFromDesktop() * onDesktop,
          .cull = options_.cull,
          .solid = options_.measure};
}

void ModelRenderer::useFor(const ModelFrame& frame, const SceneBuffers& scene, const SceneGroup& group,
                           const SceneSight& sight, bool blend) {
  // What does not reach over the display's borders need not be held to them.
  const bool clip = options_.correct && group.across;
  for (unsigned i = 0; i < 6; ++i) (clip ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + i);
  (view_.cut ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + 6);
  const Material& material = scene.material(group.material);
  const auto& drawing = shaders_.model({.lens = frame.bent(),
                                        .clip = clip,
                                        .cut = view_.cut.has_value(),
                                        .measure = options_.measure,
                                        .lit = material.lit,
                                        .shiny = material.shine != glm::vec3(0),
                                        .picture = material.picture >= 0,
                                        .cutoff = material.solidity == Solidity::kCutOut,
                                        .blend = blend});
  drawing.use();
  setMatrices(drawing, frame, sight);
  scene.setMaterial(drawing, group.material);
}

void ModelRenderer::setMatrices(const devices::GlProgram& drawing, const ModelFrame& frame,
                                const SceneSight& sight) const {
  const glm::dmat4 inWindow = windowFromModel(view_.pose, bounds_, view_.window);
  drawing.set("desktopFromModel", glm::mat4(sight.desktopFromModel));
  drawing.set("projectorFromDesktop", glm::mat4(frame.projectorFromDesktop()));
  drawing.set("windowFromModel", glm::mat4(inWindow));
  drawing.set("eye", glm::vec3(eyeOf(view_.viewer, frame.eye())));
  if (view_.cut) drawing.set("cut", glm::vec4(glm::transpose(inWindow) * *view_.cut));
  frame.setLens(drawing);
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
