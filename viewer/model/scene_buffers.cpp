#include "viewer/model/scene_buffers.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

template <class T>
devices::GlBuffer bufferOf(std::vector<T> values) {
  auto buffer = devices::GlBuffer::create();
  while (glGetError() != GL_NO_ERROR) continue;  // an old error must not be taken for this allocation's
  const auto bytes = std::as_bytes(std::span(values));
  if (bytes.empty()) return buffer;
  glNamedBufferStorage(buffer.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  if (glGetError() != GL_NO_ERROR) {
    throw RendererError(fmt::format("the model needs more graphics memory than there is ({} MiB): show a simpler one",
                                    bytes.size() >> 20));
  }
  return buffer;
}

devices::GlTexture textureOf(const devices::Image8& picture) {
  auto texture = devices::GlTexture::create(GL_TEXTURE_2D);
  const auto longest = static_cast<unsigned>(std::max(picture.width(), picture.height()));
  const auto levels = static_cast<GLsizei>(std::bit_width(longest));
  // Decoded before they are filtered, all levels too.
  glTextureStorage2D(texture.get(), levels, GL_SRGB8_ALPHA8, picture.width(), picture.height());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.get(), 0, 0, 0, picture.width(), picture.height(), GL_RGB, GL_UNSIGNED_BYTE,
                      picture.samples().data());
  glGenerateTextureMipmap(texture.get());
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.get(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

void attribute(GLuint array, GLuint index, GLint size, GLenum type, bool normalised, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, type, normalised ? GL_TRUE : GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, 0);
}

std::array<glm::dvec4, 8> cornersIn(const Bounds3& bounds, const glm::dmat4& clipFromModel) {
  std::array<glm::dvec4, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p((i & 1) != 0 ? bounds.high.x : bounds.low.x, (i & 2) != 0 ? bounds.high.y : bounds.low.y,
                       (i & 4) != 0 ? bounds.high.z : bounds.low.z);
    corners[i] = clipFromModel * glm::dvec4(p, 1);
  }
  return corners;
}

}  // namespace

bool isOutside(const Bounds3& bounds, const glm::dmat4& clipFromModel, double slack) {
  std::array<int, 6> beyond{};
  for (const auto& clip : cornersIn(bounds, clipFromModel)) {
    for (int axis = 0; axis < 3; ++axis) {
      const double most = slack * clip.w;
      if (clip[axis] < -most) ++beyond[static_cast<std::size_t>(2 * axis)];
      if (clip[axis] > most) ++beyond[static_cast<std::size_t>(2 * axis + 1)];
    }
  }
  return std::ranges::find(beyond, 8) != beyond.end();
}

bool isInside(const Bounds3& bounds, const glm::dmat4& clipFromModel) {
  return std::ranges::all_of(cornersIn(bounds, clipFromModel), [](const glm::dvec4& clip) {
    return std::max({std::abs(clip.x), std::abs(clip.y), std::abs(clip.z)}) <= clip.w;
  });
}

SceneBuffers::SceneBuffers(Scene scene)
    : parts_(std::move(scene.parts)), materials_(std::move(scene.materials)), triangles_(scene.indices.size() / 3) {
  std::ranges::stable_sort(parts_, {}, &ScenePart::material);
  for (const auto& part : parts_) bounds_.add(part.bounds);
  bytes_ = scene.vertices.size() * sizeof(SceneVertex) + scene.indices.size() * sizeof(std::uint32_t);
  vertices_ = bufferOf(std::move(scene.vertices));
  indices_ = bufferOf(std::move(scene.indices));
  vertexArray_ = devices::GlVertexArray::create();
  const auto array = vertexArray_.get();
  glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(SceneVertex));
  glVertexArrayElementBuffer(array, indices_.get());
  attribute(array, 0, 3, GL_FLOAT, false, offsetof(SceneVertex, position));
  attribute(array, 1, 4, GL_INT_2_10_10_10_REV, true, offsetof(SceneVertex, normal));
  attribute(array, 2, 2, GL_FLOAT, false, offsetof(SceneVertex, texture));
  attribute(array, 3, 4, GL_UNSIGNED_BYTE, true, offsetof(SceneVertex, colour));
  for (auto& picture : scene.pictures) pictures_.push_back(textureOf(std::exchange(picture, {})));
}

DrawnParts SceneBuffers::draw(const devices::GlProgram& program, const glm::dmat4& desktopFromModel,
                              const glm::dmat4& projectorFromModel) const {
  // A lens may bend what lies a little outside the frame into it.
  constexpr double kLensSlack = 1.1;
  std::vector<const ScenePart*> seen;
  for (const auto& part : parts_) {
    if (isOutside(part.bounds, desktopFromModel, 1) || isOutside(part.bounds, projectorFromModel, kLensSlack)) continue;
    seen.push_back(&part);
  }
  return drawParts(program, seen);
}

DrawnParts SceneBuffers::drawAll(const devices::GlProgram& program) const {
  std::vector<const ScenePart*> all;
  for (const auto& part : parts_) all.push_back(&part);
  return drawParts(program, all);
}

DrawnParts SceneBuffers::drawParts(const devices::GlProgram& program,
                                   const std::vector<const ScenePart*>& parts) const {
  glBindVertexArray(vertexArray_.get());
  DrawnParts drawn{.parts = parts.size()};
  for (std::size_t i = 0; i < parts.size();) {
    const int material = parts[i]->material;
    setMaterial(program, materials_[static_cast<std::size_t>(material)]);
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
    for (; i < parts.size() && parts[i]->material == material; ++i) {
      counts.push_back(static_cast<GLsizei>(parts[i]->count));
      offsets.push_back(reinterpret_cast<const void*>(sizeof(std::uint32_t) * std::uintptr_t{parts[i]->first}));
      drawn.triangles += parts[i]->count / 3;
    }
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                        static_cast<GLsizei>(counts.size()));
  }
  return drawn;
}

void SceneBuffers::setMaterial(const devices::GlProgram& program, const Material& material) const {
  program.set("materialColour", material.colour);
  program.set("lit", material.lit ? 1 : 0);
  program.set("hasPicture", material.picture >= 0 ? 1 : 0);
  if (material.picture >= 0) glBindTextureUnit(0, pictures_[static_cast<std::size_t>(material.picture)].get());
}

}  // namespace pixelflex::viewer
