#include "tests/gl/mesh_count.h"

#include <epoxy/gl.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"

namespace pixelflex::testing {
namespace {

constexpr const char* kVertex = R"(
layout(location = 0) in vec2 pixelInProjector;
uniform vec2 resolution;
void main() { gl_Position = vec4(2.0 * pixelInProjector / resolution - 1.0, 0.0, 1.0); }
)";
constexpr const char* kFragment = R"(
layout(location = 0) out float count;
void main() { count = 1.0; }
)";

/// Float pixels that begin at zero.
struct Counter {
  devices::GlTexture texture;
  devices::GlFramebuffer framebuffer;
};

Counter makeCounter(devices::Size size) {
  Counter counter{devices::GlTexture::create(GL_TEXTURE_2D), devices::GlFramebuffer::create()};
  glTextureStorage2D(counter.texture.get(), 1, GL_R32F, size.width, size.height);
  glNamedFramebufferTexture(counter.framebuffer.get(), GL_COLOR_ATTACHMENT0, counter.texture.get(), 0);
  if (glCheckNamedFramebufferStatus(counter.framebuffer.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("cannot draw into floats");
  }
  constexpr GLfloat kZero[] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(counter.framebuffer.get(), GL_COLOR, 0, kZero);
  return counter;
}

devices::GlBuffer bufferOf(std::span<const std::byte> bytes) {
  auto buffer = devices::GlBuffer::create();
  glNamedBufferStorage(buffer.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return buffer;
}

void drawAdding(const viewer::WarpMesh& mesh) {
  // Unrolled triangle by triangle, as the renderer does it.
  std::vector<viewer::WarpVertex> corners;
  for (const auto index : mesh.indices) corners.push_back(mesh.vertices[index]);
  const auto vertices = bufferOf(std::as_bytes(std::span(corners)));
  const auto array = devices::GlVertexArray::create();
  glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, sizeof(viewer::WarpVertex));
  glEnableVertexArrayAttrib(array.get(), 0);
  glVertexArrayAttribFormat(array.get(), 0, 2, GL_FLOAT, GL_FALSE, offsetof(viewer::WarpVertex, x));
  glVertexArrayAttribBinding(array.get(), 0, 0);
  glBindVertexArray(array.get());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquation(GL_FUNC_ADD);
  for (const auto& patch : mesh.patches) {
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(patch.firstIndex), static_cast<GLsizei>(patch.indexCount));
  }
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

}  // namespace

devices::Image<int> countTriangles(const viewer::WarpMesh& mesh, devices::Size resolution) {
  const devices::GlProgram program("count", {kVertex}, {kFragment});
  const Counter counter = makeCounter(resolution);
  glBindFramebuffer(GL_FRAMEBUFFER, counter.framebuffer.get());
  glViewport(0, 0, resolution.width, resolution.height);
  glDisable(GL_SCISSOR_TEST);
  program.use();
  program.set("resolution", glm::vec2(resolution.width, resolution.height));
  if (!mesh.indices.empty()) drawAdding(mesh);
  std::vector<float> counted(static_cast<std::size_t>(resolution.area()));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(counter.texture.get(), 0, GL_RED, GL_FLOAT, static_cast<GLsizei>(counted.size() * sizeof(float)),
                    counted.data());
  devices::Image<int> count(resolution, 1);
  for (std::size_t i = 0; i < counted.size(); ++i) count.samples()[i] = static_cast<int>(std::lround(counted[i]));
  return count;
}

}  // namespace pixelflex::testing
