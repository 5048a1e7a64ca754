#include "devices/display/gl_program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace pixelflex::devices {
namespace {

constexpr std::string_view kVersion = "#version 450 core\n";

GlShader compile(std::string_view name, GLenum stage, const ShaderPieces& pieces) {
  auto shader = GlShader::create(stage);
  std::vector<const GLchar*> texts{kVersion.data()};
  std::vector<GLint> lengths{static_cast<GLint>(kVersion.size())};
  for (const auto piece : pieces) {
    texts.push_back(piece.data());
    lengths.push_back(static_cast<GLint>(piece.size()));
  }
  glShaderSource(shader.get(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  glCompileShader(shader.get());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  const auto* const kind = stage == GL_VERTEX_SHADER ? "vertex" : "fragment";
  throw DisplayError(fmt::format("the {} shader of '{}' does not compile:\n{}", kind, name, log));
}

void link(std::string_view name, GlName program) {
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw DisplayError(fmt::format("the shaders of '{}' do not link:\n{}", name, log));
}

std::map<std::string, int, std::less<>> locationsIn(GLuint program) {
  std::map<std::string, int, std::less<>> locations;
  GLint count = 0;
  GLint longest = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  glGetProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
  for (GLint i = 0; i < count; ++i) {
    GLsizei length = 0;
    GLint extent = 0;
    GLenum type = 0;
    glGetActiveUniform(program, static_cast<GLuint>(i), longest, &length, &extent, &type, name.data());
    const std::string uniform = name.substr(0, static_cast<std::size_t>(length));
    locations.emplace(uniform, glGetUniformLocation(program, uniform.c_str()));
  }
  return locations;
}

}  // namespace

GlProgram::GlProgram(std::string_view name, const ShaderPieces& vertex, const ShaderPieces& fragment)
    : program_(GlProgramName::create()) {
  const auto vertexShader = compile(name, GL_VERTEX_SHADER, vertex);
  const auto fragmentShader = compile(name, GL_FRAGMENT_SHADER, fragment);
  glAttachShader(program_.get(), vertexShader.get());
  glAttachShader(program_.get(), fragmentShader.get());
  link(name, program_.get());
  glDetachShader(program_.get(), vertexShader.get());
  glDetachShader(program_.get(), fragmentShader.get());
  locations_ = locationsIn(program_.get());
}

void GlProgram::use() const {
  glUseProgram(program_.get());
}

int GlProgram::location(std::string_view uniform) const {
  const auto found = locations_.find(uniform);
  return found == locations_.end() ? -1 : found->second;
}

void GlProgram::set(const char* uniform, int value) const {
  glProgramUniform1i(program_.get(), location(uniform), value);
}
void GlProgram::set(const char* uniform, float value) const {
  glProgramUniform1f(program_.get(), location(uniform), value);
}
void GlProgram::set(const char* uniform, glm::vec2 value) const {
  glProgramUniform2f(program_.get(), location(uniform), value.x, value.y);
}
void GlProgram::set(const char* uniform, const glm::vec3& value) const {
  glProgramUniform3f(program_.get(), location(uniform), value.x, value.y, value.z);
}
void GlProgram::set(const char* uniform, glm::vec4 value) const {
  glProgramUniform4f(program_.get(), location(uniform), value.x, value.y, value.z, value.w);
}
void GlProgram::set(const char* uniform, glm::ivec2 value) const {
  glProgramUniform2i(program_.get(), location(uniform), value.x, value.y);
}
void GlProgram::set(const char* uniform, glm::ivec3 value) const {
  glProgramUniform3i(program_.get(), location(uniform), value.x, value.y, value.z);
}
void GlProgram::set(const char* uniform, const glm::mat3& value) const {
  glProgramUniformMatrix3fv(program_.get(), location(uniform), 1, GL_FALSE, &value[0][0]);
}
void GlProgram::set(const char* uniform, const glm::mat4& value) const {
  glProgramUniformMatrix4fv(program_.get(), location(uniform), 1, GL_FALSE, &value[0][0]);
}

}  // namespace pixelflex::devices
