#pragma once

#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "devices/display/display_error.h"
#include "devices/display/gl_handle.h"

namespace pixelflex::devices {

/// The sources of one shader stage: pieces that are put together in this order. `#version 450 core` is added in front.
using ShaderPieces = std::vector<std::string_view>;

/// A linked vertex and fragment shader. Needs its context current for every call.
class GlProgram {
 public:
  /// Throws DisplayError with `name` and the compiler's or linker's log.
  GlProgram(std::string_view name, const ShaderPieces& vertex, const ShaderPieces& fragment);

  void use() const;

  /// Uniforms by name; one that the compiler removed is ignored, as GL does.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, glm::vec2 value) const;
  void set(const char* uniform, const glm::vec3& value) const;
  void set(const char* uniform, glm::vec4 value) const;
  void set(const char* uniform, glm::ivec2 value) const;
  void set(const char* uniform, glm::ivec3 value) const;
  void set(const char* uniform, const glm::mat3& value) const;
  void set(const char* uniform, const glm::mat4& value) const;

 private:
  [[nodiscard]] int location(std::string_view uniform) const;

  GlProgramName program_;
  std::map<std::string, int, std::less<>> locations_;  // the driver need not be asked while drawing
};

}  // namespace pixelflex::devices
