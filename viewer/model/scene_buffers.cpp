#include "viewer/model/scene_buffers.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "viewer/model/picture_texture.h"
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
  for (const auto& part : parts_) {
    if (material(part.material).solidity == Solidity::kClear) clear_.add(scene, part);
  }
  bytes_ = scene.vertices.size() * sizeof(SceneVertex) + scene.indices.size() * sizeof(std::uint32_t);
  vertices_ = bufferOf(std::move(scene.vertices));
  indices_ = bufferOf(std::move(scene.indices));
  makeVertexArray();
  std::vector<bool> weighted(scene.pictures.size(), false);
  for (const auto& own : materials_) {
    if (own.picture >= 0 && own.solidity != Solidity::kOpaque) weighted[static_cast<std::size_t>(own.picture)] = true;
  }
  for (std::size_t i = 0; i < weighted.size(); ++i) {
    pictures_.push_back(pictureTexture(std::exchange(scene.pictures[i], {}), weighted[i]));
  }
}

void SceneBuffers::makeVertexArray() {
  vertexArray_ = devices::GlVertexArray::create();
  const auto array = vertexArray_.get();
  glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(SceneVertex));
  attribute(array, 0, 3, GL_FLOAT, false, offsetof(SceneVertex, position));
  attribute(array, 1, 4, GL_INT_2_10_10_10_REV, true, offsetof(SceneVertex, normal));
  attribute(array, 2, 2, GL_FLOAT, false, offsetof(SceneVertex, texture));
  attribute(array, 3, 4, GL_UNSIGNED_BYTE, true, offsetof(SceneVertex, colour));
}

bool SceneBuffers::isSeen(const ScenePart& part, const SceneSight& sight) const {
  // A lens may bend what lies a little outside the frame into it.
  constexpr double kLensSlack = 1.1;
  return !sight.cull || !(isOutside(part.bounds, sight.desktopFromModel, 1) ||
                          isOutside(part.bounds, sight.projectorFromModel, kLensSlack));
}

std::vector<SceneGroup> SceneBuffers::solidGroups(const SceneSight& sight) const {
  std::vector<SceneGroup> groups;
  for (auto part = parts_.begin(); part != parts_.end();) {
    const int number = part->material;
    std::array<SceneGroup, 2> own{SceneGroup{.material = number}, SceneGroup{.material = number, .across = true}};
    const bool passed = !sight.solid && material(number).solidity == Solidity::kClear;
    for (; part != parts_.end() && part->material == number; ++part) {
      if (passed || !isSeen(*part, sight)) continue;
      SceneGroup& group = own[isInside(part->bounds, sight.desktopFromModel) ? 0 : 1];
      group.counts.push_back(static_cast<int>(part->count));
      group.offsets.push_back(reinterpret_cast<const void*>(sizeof(std::uint32_t) * std::uintptr_t{part->first}));
      ++group.drawn.parts;
      group.drawn.triangles += part->count / 3;
    }
    for (auto& group : own) {
      if (!group.counts.empty()) groups.push_back(std::move(group));
    }
  }
  return groups;
}

std::vector<SceneGroup> SceneBuffers::clearGroups(const SceneSight& sight, glm::vec3 eyeInModel) {
  bool across = false;
  bool seen = false;
  for (const auto& part : parts_) {
    if (material(part.material).solidity != Solidity::kClear) continue;
    seen = seen || isSeen(part, sight);
    across = across || !isInside(part.bounds, sight.desktopFromModel);
  }
  std::vector<SceneGroup> groups;
  if (!seen) return groups;
  for (const auto& run : clear_.fromTheBack(eyeInModel)) {
    groups.push_back({.material = run.material,
                      .across = across,
                      .counts = {static_cast<int>(3 * run.count)},
                      .offsets = {reinterpret_cast<const void*>(3 * sizeof(std::uint32_t) * run.first)},
                      .drawn = {1, run.count}});
  }
  return groups;
}

void SceneBuffers::drawSolid(const SceneGroup& group) const {
  glVertexArrayElementBuffer(vertexArray_.get(), indices_.get());
  glBindVertexArray(vertexArray_.get());
  glMultiDrawElements(GL_TRIANGLES, group.counts.data(), GL_UNSIGNED_INT, group.offsets.data(),
                      static_cast<GLsizei>(group.counts.size()));
}

void SceneBuffers::drawClear(const SceneGroup& group) const {
  glVertexArrayElementBuffer(vertexArray_.get(), clear_.buffer());
  glBindVertexArray(vertexArray_.get());
  glMultiDrawElements(GL_TRIANGLES, group.counts.data(), GL_UNSIGNED_INT, group.offsets.data(),
                      static_cast<GLsizei>(group.counts.size()));
}

void SceneBuffers::setMaterial(const devices::GlProgram& program, int number) const {
  const Material& own = material(number);
  program.set("materialColour", own.colour);
  program.set("emission", own.emission);
  program.set("opacity", own.opacity);
  program.set("cutoff", own.cutoff);
  program.set("shine", own.shine);
  program.set("shininess", own.shininess);
  program.set("picture", 0);
  if (own.picture >= 0) glBindTextureUnit(0, pictures_[static_cast<std::size_t>(own.picture)].get());
}

}  // namespace pixelflex::viewer
