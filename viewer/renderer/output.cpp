#include "viewer/renderer/output.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

enum TextureUnit : GLuint { kDesktopUnit, kMaskUnit, kResponseUnit, kCursorUnit };

void checkResolution(const OutputPlan& plan) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const auto [width, height] = plan.resolution;
  if (width > 0 && height > 0 && width <= largest && height <= largest) return;
  throw RendererError(
      fmt::format("output '{}' of {}x{} pixels: must be 1 to {} each way", plan.name, width, height, largest));
}

void checkSameSize(const OutputPlan& plan) {
  if (plan.alpha.empty() || (plan.alpha.size() == plan.resolution && plan.alpha.channels() == 1)) return;
  throw RendererError(fmt::format("the alpha mask of '{}' is {}x{} with {} channels, the output {}x{}", plan.name,
                                  plan.alpha.width(), plan.alpha.height(), plan.alpha.channels(), plan.resolution.width,
                                  plan.resolution.height));
}

bool hasResponse(const OutputPlan& plan) {
  const auto absent = std::count_if(plan.inverseResponse.begin(), plan.inverseResponse.end(),
                                    [](const auto& channel) { return channel.empty(); });
  const bool tooShort = std::any_of(plan.inverseResponse.begin(), plan.inverseResponse.end(),
                                    [](const auto& channel) { return channel.size() == 1; });
  if (absent % 3 != 0 || tooShort) {
    throw RendererError(
        fmt::format("the inverse response of '{}' needs two or more entries for each of red, green and "
                    "blue",
                    plan.name));
  }
  return absent == 0;
}

devices::GlTexture textureOf(GLenum format, int width, int height) {
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture.get(), 1, format, width, height);
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

void attribute(GLuint array, GLuint index, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, 0);
}

}  // namespace

Output::Output(const OutputPlan& plan, const TileLayout& layout, bool measure)
    : name_(plan.name), resolution_(plan.resolution), desktop_(plan.desktop) {
  checkResolution(plan);
  variant_.measure = measure;
  variant_.filter = plan.filter;
  variant_.transfer = plan.transfer;
  makeFrame(measure);
  if (plan.exactAt) {
    variant_.exact = true;
    exactAt_ = *plan.exactAt;
    vertexArray_ = devices::GlVertexArray::create();
  } else {
    checkSameSize(plan);
    variant_.dither = plan.dither;
    variant_.mask = !plan.alpha.empty();
    variant_.response = hasResponse(plan);
    footprint_ = MeshFootprint(plan, layout);
    makeMesh();
    if (variant_.mask) makeMask(plan.alpha);
    if (variant_.response) makeResponse(plan);
  }
  markAll();
}

void Output::makeFrame(bool measure) {
  frame_ = textureOf(measure ? GL_RGBA32F : GL_RGBA8, resolution_.width, resolution_.height);
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

void Output::makeMask(const devices::Image16& alpha) {
  mask_ = textureOf(GL_R16, alpha.width(), alpha.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(mask_.get(), 0, 0, 0, alpha.width(), alpha.height(), GL_RED, GL_UNSIGNED_SHORT,
                      alpha.samples().data());
}

void Output::makeResponse(const OutputPlan& plan) {
  for (int channel = 0; channel < 3; ++channel) {
    responseEntries_[channel] = static_cast<int>(plan.inverseResponse[static_cast<std::size_t>(channel)].size());
  }
  const auto longest = std::max({responseEntries_.x, responseEntries_.y, responseEntries_.z});
  response_ = textureOf(GL_R32F, longest, 3);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (int channel = 0; channel < 3; ++channel) {
    glTextureSubImage2D(response_.get(), 0, 0, channel, responseEntries_[channel], 1, GL_RED, GL_FLOAT,
                        plan.inverseResponse[static_cast<std::size_t>(channel)].data());
  }
}

Box Output::touchedBy(const Box& desktopBox) const {
  if (!variant_.exact) return footprint_.touchedBy(desktopBox);
  const auto inside = intersect(desktopBox, boxOf(desktop_));
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
  glBindTextureUnit(kMaskUnit, mask_.get());
  glBindTextureUnit(kResponseUnit, response_.get());
  glBindTextureUnit(kCursorUnit, cursor.texture());
  std::uint64_t pixels = 0;
  for (const auto& box : marked_.boxes()) {
    drawBox(box, desktop, cursor, programs);
    pixels += static_cast<std::uint64_t>(box.area());
  }
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
  program.set("mask", static_cast<int>(kMaskUnit));
  program.set("inverseResponse", static_cast<int>(kResponseUnit));
  program.set("cursorImage", static_cast<int>(kCursorUnit));
  program.set("cursorAt", cursor.topLeft());
  program.set("resolution", glm::vec2(resolution_.width, resolution_.height));
  program.set("desktopSize", glm::ivec2(desktop_.width, desktop_.height));
  program.set("tiling", glm::ivec3(desktop.layout().columns(), kTileStride, kTileApron));
  program.set("responseEntries", responseEntries_);
  program.set("exactAt", exactAt_);
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

devices::ImageF Output::readFloat() const {
  devices::ImageF image(resolution_, 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(frame_.get(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.samples().size_bytes()),
                    image.samples().data());
  return image;
}

}  // namespace pixelflex::viewer
