#include "viewer/renderer/room_view.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <glm/common.hpp>

#include "shader_sources.h"
#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kCodes = 256;
constexpr std::string_view kToneDefinitions =
    "#define RESPONSE 0\n#define LINEAR_DESKTOP 0\n#define DITHER 0\n#define TEN_BITS 0\n";

devices::GlTexture textureOf(GLenum format, devices::Size size, GLint filter = GL_NEAREST) {
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture.get(), 1, format, size.width, size.height);
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.get(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

devices::GlFramebuffer targetOf(devices::GlName texture) {
  auto target = devices::GlFramebuffer::create();
  glNamedFramebufferTexture(target.get(), GL_COLOR_ATTACHMENT0, texture, 0);
  return target;
}

void check(const RoomMesh& mesh) {
  const auto count = mesh.vertices.size();
  const bool indicesSound = mesh.indices.size() % 3 == 0 &&
                            std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](auto i) { return i < count; });
  const bool responseSound =
      std::all_of(mesh.response.begin(), mesh.response.end(), [](const auto& c) { return c.size() == kCodes; });
  if (!indicesSound) throw RendererError("a room mesh has an index without a vertex or an incomplete triangle");
  if (!responseSound) throw RendererError(fmt::format("a room mesh needs {} response entries per channel", kCodes));
}

void attribute(GLuint array, GLuint index, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, 0);
}

template <class Element>
devices::GlBuffer bufferOf(const std::vector<Element>& elements) {
  auto buffer = devices::GlBuffer::create();
  const auto bytes = std::as_bytes(std::span(elements));
  if (!bytes.empty()) glNamedBufferStorage(buffer.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return buffer;
}

devices::GlTexture responseOf(const RoomMesh& mesh) {
  std::vector<float> table;
  for (std::size_t code = 0; code < kCodes; ++code) {
    for (const auto& channel : mesh.response) table.push_back(channel[code]);
    table.push_back(1);
  }
  auto texture = textureOf(GL_RGBA32F, {static_cast<int>(kCodes), 1});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture.get(), 0, 0, 0, static_cast<GLsizei>(kCodes), 1, GL_RGBA, GL_FLOAT, table.data());
  return texture;
}

}  // namespace

double RoomFraming::pixelsPerUnit() const {
  const auto extent = bottomRight - topLeft;
  return std::min(picture.width / extent.x, picture.height / extent.y);
}

glm::dvec2 RoomFraming::pictureFromWall(glm::dvec2 pointInWall) const {
  const glm::dvec2 middle = (topLeft + bottomRight) / 2.0;
  return (pointInWall - middle) * pixelsPerUnit() + glm::dvec2(picture.width, picture.height) / 2.0;
}

glm::dvec2 RoomFraming::wallFromPicture(glm::dvec2 pixel) const {
  const glm::dvec2 middle = (topLeft + bottomRight) / 2.0;
  return (pixel - glm::dvec2(picture.width, picture.height) / 2.0) / pixelsPerUnit() + middle;
}

RoomView::RoomView(devices::GlContext& context, const std::vector<RoomMesh>& projectors)
    : context_((context.makeCurrent(), context)),
      decodeProgram_("framelight", {shaders::kFullscreenVert}, {shaders::kFramelightFrag}),
      lightProgram_("room", {shaders::kRoomVert}, {shaders::kRoomFrag}),
      toneProgram_("tonemap", {shaders::kFullscreenVert},
                   {kToneDefinitions, shaders::kLightGlsl, shaders::kTonemapFrag}),
      noVertices_(devices::GlVertexArray::create()) {
  for (const auto& mesh : projectors) {
    check(mesh);
    projectors_.push_back(makeProjector(mesh));
  }
}

RoomView::~RoomView() {
  try {
    context_.makeCurrent();
  } catch (const devices::DisplayError&) {
    return;  // the context is gone and its objects with it
  }
}

RoomView::Projector RoomView::makeProjector(const RoomMesh& mesh) {
  Projector projector;
  projector.vertices = bufferOf(mesh.vertices);
  projector.indices = bufferOf(mesh.indices);
  projector.indexCount = static_cast<int>(mesh.indices.size());
  projector.response = responseOf(mesh);
  projector.resolution = mesh.resolution;
  projector.light = textureOf(GL_RGBA16F, mesh.resolution, GL_LINEAR);
  projector.lightTarget = targetOf(projector.light.get());
  for (const auto& v : mesh.vertices) {
    const glm::dvec2 inWall(v.wallX, v.wallY);
    const bool first = &v == mesh.vertices.data();
    projector.firstInWall = first ? inWall : glm::min(projector.firstInWall, inWall);
    projector.lastInWall = first ? inWall : glm::max(projector.lastInWall, inWall);
  }
  projector.vertexArray = devices::GlVertexArray::create();
  const auto array = projector.vertexArray.get();
  glVertexArrayVertexBuffer(array, 0, projector.vertices.get(), 0, sizeof(RoomVertex));
  glVertexArrayElementBuffer(array, projector.indices.get());
  attribute(array, 0, 2, offsetof(RoomVertex, x));
  attribute(array, 1, 2, offsetof(RoomVertex, wallX));
  attribute(array, 2, 1, offsetof(RoomVertex, radiance));
  return projector;
}

void RoomView::setLight(glm::vec3 ambient, float exposure) {
  ambient_ = ambient;
  exposure_ = exposure;
  stale_ = true;
}

void RoomView::makeTargets(devices::Size size) {
  light_ = textureOf(GL_RGBA16F, size);
  picture_ = textureOf(GL_RGBA8, size);
  lightTarget_ = targetOf(light_.get());
  pictureTarget_ = targetOf(picture_.get());
}

Box RoomView::boxInPicture(const Projector& projector) const {
  const auto first = framing_.pictureFromWall(projector.firstInWall);
  const auto last = framing_.pictureFromWall(projector.lastInWall);
  const glm::dvec2 end(framing_.picture.width, framing_.picture.height);
  const auto low = glm::ivec2(glm::clamp(glm::floor(first) - 1.0, glm::dvec2(0), end));
  const auto high = glm::ivec2(glm::clamp(glm::ceil(last) + 1.0, glm::dvec2(0), end));
  return {low.x, low.y, high.x, high.y};
}

void RoomView::decode(const Projector& projector, devices::GlName frame) const {
  glBindFramebuffer(GL_FRAMEBUFFER, projector.lightTarget.get());
  glViewport(0, 0, projector.resolution.width, projector.resolution.height);
  decodeProgram_.use();
  decodeProgram_.set("frame", 0);
  decodeProgram_.set("response", 1);
  glBindTextureUnit(0, frame);
  glBindTextureUnit(1, projector.response.get());
  glBindVertexArray(noVertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// All projectors into the sum, within the scissor's box.
void RoomView::addLight() const {
  const GLfloat dark[] = {ambient_.r, ambient_.g, ambient_.b, 1};
  const auto scale = framing_.pixelsPerUnit();
  const auto shift = framing_.pictureFromWall({0, 0});
  glBindFramebuffer(GL_FRAMEBUFFER, lightTarget_.get());
  glViewport(0, 0, framing_.picture.width, framing_.picture.height);
  glClearBufferfv(GL_COLOR, 0, dark);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  lightProgram_.use();
  lightProgram_.set("frameFromWall", glm::vec4(scale, scale, shift.x, shift.y));
  lightProgram_.set("frameSize", glm::vec2(framing_.picture.width, framing_.picture.height));
  lightProgram_.set("frameLight", 0);
  for (const auto& projector : projectors_) {
    glBindTextureUnit(0, projector.light.get());
    glBindVertexArray(projector.vertexArray.get());
    glDrawElements(GL_TRIANGLES, projector.indexCount, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_BLEND);
}

void RoomView::toneMap() const {
  glBindFramebuffer(GL_FRAMEBUFFER, pictureTarget_.get());
  toneProgram_.use();
  toneProgram_.set("wallLight", 0);
  toneProgram_.set("exposure", exposure_);
  glBindTextureUnit(0, light_.get());
  glBindVertexArray(noVertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void RoomView::draw(std::span<const devices::GlName> frames, std::span<const std::size_t> changed,
                    const RoomFraming& framing) {
  assert(frames.size() == projectors_.size());
  context_.makeCurrent();
  const bool first = !light_;
  if (first || framing.picture != framing_.picture) makeTargets(framing.picture);
  const bool everything = first || stale_ || framing != framing_;
  framing_ = framing;
  stale_ = false;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DITHER);
  glDisable(GL_BLEND);
  Box box = everything ? boxOf(framing.picture) : Box{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!first && std::find(changed.begin(), changed.end(), i) == changed.end()) continue;
    decode(projectors_[i], frames[i]);
    box = enclose(box, boxInPicture(projectors_[i]));
  }
  if (box.empty()) return;
  glEnable(GL_SCISSOR_TEST);
  glScissor(box.left, box.top, box.width(), box.height());
  addLight();
  toneMap();
  glDisable(GL_SCISSOR_TEST);
  glFinish();
}

devices::Image8 RoomView::read() {
  context_.makeCurrent();
  devices::Image8 image(framing_.picture, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(picture_.get(), 0, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(image.samples().size()),
                    image.samples().data());
  return image;
}

}  // namespace pixelflex::viewer
