#include "viewer/renderer/output.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "viewer/renderer/dither_tile.h"
#include "viewer/renderer/one_to_one.h"
#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

void checkResolution(const OutputPlan& plan) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const auto [width, height] = plan.resolution;
  if (width > 0 && height > 0 && width <= largest && height <= largest) return;
  throw RendererError(
      fmt::format("output '{}' of {}x{} pixels: must be 1 to {} each way", plan.name, width, height, largest));
}

GLenum formatOf(FrameFormat format) {
  switch (format) {
    case FrameFormat::kRgb10:
      return GL_RGB10_A2;
    case FrameFormat::kRgba32F:
      return GL_RGBA32F;
    case FrameFormat::kRgba8:
      break;
  }
  return GL_RGBA8;
}

void attribute(GLuint array, GLuint index, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, 0);
}

}  // namespace

Output::Output(const OutputPlan& plan, const TileLayout& layout, FrameFormat format)
    : name_(plan.name), resolution_(plan.resolution), desktop_(plan.desktop), format_(format) {
  checkResolution(plan);
  variant_.measure = format == FrameFormat::kRgba32F;
  variant_.tenBits = format == FrameFormat::kRgb10;
  variant_.transfer = plan.transfer;
  makeFrame();
  if (plan.exactAt) {
    variant_.exact = true;
    exactAt_ = *plan.exactAt;
    exactShown_ = intersect(plan.exactShown.value_or(boxOf(desktop_)), boxOf(desktop_));
    vertexArray_ = devices::GlVertexArray::create();
  } else {
    variant_.dither = plan.dither;
    light_ = OutputLight(plan);
    light_.addTo(variant_);
    footprint_ = MeshFootprint(plan, layout);
    makeMesh();
    chooseFilter(plan);
  }
  markAll();
}

/// What is measured is the mesh, so there a filter that keeps positions is used in any case.
void Output::chooseFilter(const OutputPlan& plan) {
  const bool unfiltered = !variant_.measure && showsPixelsOneToOne(plan.mesh);
  variant_.filter = unfiltered ? Filter::kNearest : plan.filter;
  variant_.filterLight = !variant_.measure && variant_.filter != Filter::kNearest &&
                         plan.filterDomain == FilterDomain::kLinear && plan.transfer == DesktopTransfer::kSrgb;
}

void Output::makeFrame() {
  frame_ = makeTexture(formatOf(format_), resolution_);
  framebuffer_ = devices::GlFramebuffer::create();
  glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, frame_.get(), 0);
  if (glCheckNamedFramebufferStatus(framebuffer_.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw RendererError(fmt::format("output '{}': the graphics driver cannot draw into {}x{} pixels", name_,
                                    resolution_.width, resolution_.height));
  }
}

void Output::makeMesh() {
  vertexArray_ = devices::GlVertexArray::create();
  vertices_ = devices::GlBuffer::create();
  const auto bytes = std::as_bytes(footprint_.vertices());
  if (bytes.empty()) return;
  glNamedBufferStorage(vertices_.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  const auto array = vertexArray_.get();
  glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(TileVertex));
  attribute(array, 0, 2, offsetof(TileVertex, x));
  attribute(array, 1, 3, offsetof(TileVertex, uw));
  glEnableVertexArrayAttrib(array, 2);
  glVertexArrayAttribIFormat(array, 2, 1, GL_INT, offsetof(TileVertex, layer));
  glVertexArrayAttribBinding(array, 2, 0);
}

Box Output::touchedBy(const Box& desktopBox) const {
  if (!variant_.exact) return footprint_.touchedBy(desktopBox);
  const auto inside = intersect(desktopBox, exactShown_);
  const Box moved{inside.left - exactAt_.x, inside.top - exactAt_.y, inside.right - exactAt_.x,
                  inside.bottom - exactAt_.y};
  return inside.empty() ? Box{} : intersect(moved, boxOf(resolution_));
}

void Output::mark(const Box& desktopBox) {
  const auto touched = touchedBy(desktopBox);
  if (!touched.empty()) marked_.add(touched);
}

void Output::markAll() {
  marked_.clear();
  marked_.add(boxOf(resolution_));
}

void Output::setBrightness(float brightness) {
  brightness_ = brightness;
  markAll();
}

std::uint64_t Output::draw(DesktopTexture& desktop, const Cursor& cursor, WarpPrograms& programs) {
  if (variant_.exact) {
    for (int layer = 0; layer < desktop.layout().count(); ++layer) {
      const auto touched = touchedBy(desktop.layout().patch(layer));
      if (!touched.empty()) desktop.prepare(layer);
    }
  } else {
    for (const int layer : footprint_.layers()) desktop.prepare(layer);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, resolution_.width, resolution_.height);
  glBindVertexArray(vertexArray_.get());
  glBindTextureUnit(kDesktopUnit, desktop.texture());
  glBindTextureUnit(kCursorUnit, cursor.texture());
  light_.bind();
  if (variant_.dither) glBindTextureUnit(kNoiseUnit, programs.ditherTile());
  overlay_.note(marked_, stale_);
  for (const auto& box : stale_.boxes()) marked_.add(intersect(box, boxOf(resolution_)));
  stale_.clear();
  std::uint64_t pixels = 0;
  for (const auto& box : marked_.boxes()) {
    drawBox(box, desktop, cursor, programs);
    pixels += static_cast<std::uint64_t>(box.area());
  }
  for (const auto& box : marked_.boxes()) overlay_.draw(box, programs);
  std::swap(drawn_, marked_);
  marked_.clear();
  return pixels;
}

void Output::drawBox(const Box& box, const DesktopTexture& desktop, const Cursor& cursor,
                     WarpPrograms& programs) const {
  auto variant = variant_;
  const auto cursorBox = cursor.box();
  variant.cursor = !cursorBox.empty() && !variant.measure && !intersect(touchedBy(cursorBox), box).empty();
  glScissor(box.left, box.top, box.width(), box.height());
  const auto& program = programs.get(variant);
  program.use();
  setUniforms(program, desktop, cursor);
  if (variant.exact) {
    glDrawArrays(GL_TRIANGLES, 0, 3);
  } else {
    constexpr GLfloat kBlack[] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, kBlack);
    drawMesh(box);
  }
}

void Output::setUniforms(const devices::GlProgram& program, const DesktopTexture& desktop, const Cursor& cursor) const {
  program.set("desktop", static_cast<int>(kDesktopUnit));
  program.set("cursorImage", static_cast<int>(kCursorUnit));
  program.set("noise", static_cast<int>(kNoiseUnit));
  program.set("noiseMask", kDitherExtent - 1);
  program.set("highestCode", variant_.tenBits ? 1023.0F : 255.0F);
  light_.setUniforms(program);
  program.set("cursorAt", cursor.topLeft());
  program.set("resolution", glm::vec2(resolution_.width, resolution_.height));
  program.set("desktopSize", glm::ivec2(desktop_.width, desktop_.height));
  program.set("tiling", glm::ivec3(desktop.layout().columns(), kTileStride, kTileApron));
  program.set("exactAt", exactAt_);
  program.set("exactFrom", glm::ivec2(exactShown_.left, exactShown_.top));
  program.set("exactTo", glm::ivec2(exactShown_.right, exactShown_.bottom));
  // The exact shader knows codes only, and those of most desktops are close to this power of light.
  program.set("brightness", variant_.exact ? std::pow(brightness_, 1.0F / 2.2F) : brightness_);
}

void Output::drawMesh(const Box& box) const {
  std::vector<GLint> first;
  std::vector<GLsizei> count;
  for (const auto& run : footprint_.trianglesIn(box)) {
    first.push_back(run.first);
    count.push_back(run.count);
  }
  if (!first.empty()) glMultiDrawArrays(GL_TRIANGLES, first.data(), count.data(), static_cast<GLsizei>(first.size()));
}

devices::Image8 Output::read() const {
  devices::Image8 image(resolution_, 3);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(resolution_.area()) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(frame_.get(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()), pixels.data());
  auto to = image.samples();
  for (std::size_t i = 0, j = 0; i < pixels.size(); i += 4, j += 3) std::copy_n(&pixels[i], 3, &to[j]);
  return image;
}

devices::Image16 Output::read16() const {
  devices::Image16 image(resolution_, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(frame_.get(), 0, GL_RGB, GL_UNSIGNED_SHORT, static_cast<GLsizei>(image.samples().size_bytes()),
                    image.samples().data());
  return image;
}

devices::ImageF Output::readFloat() const {
  devices::ImageF image(resolution_, 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(frame_.get(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.samples().size_bytes()),
                    image.samples().data());
  return image;
}

}  // namespace pixelflex::viewer
