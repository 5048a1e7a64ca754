#pragma once

#include <cstdint>
#include <utility>

namespace pixelflex::devices {

/// What GL calls a GLuint; zero names nothing.
using GlName = std::uint32_t;

/// The one owner of a GL name. Kind has static functions `GlName create(...)` and `void destroy(GlName)`. The context
/// that the name belongs to (or one that shares with it) must be current when the handle dies.
template <class Kind>
class GlHandle {
 public:
  GlHandle() = default;
  ~GlHandle() { reset(); }
  GlHandle(GlHandle&& other) noexcept : name_(other.release()) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = other.release();
    }
    return *this;
  }
  GlHandle(const GlHandle&) = delete;
  GlHandle& operator=(const GlHandle&) = delete;

  /// A new GL object; the arguments are the kind's own, GL enumerators.
  template <class... Arguments>
  [[nodiscard]] static GlHandle create(Arguments... arguments) {
    return adopt(Kind::create(static_cast<std::uint32_t>(arguments)...));
  }
  /// Takes over a name that somebody else made.
  [[nodiscard]] static GlHandle adopt(GlName name) {
    GlHandle handle;
    handle.name_ = name;
    return handle;
  }

  /// Gives the name away, undestroyed.
  [[nodiscard]] GlName release() { return std::exchange(name_, 0); }
  void reset() {
    if (name_ != 0) Kind::destroy(std::exchange(name_, 0));
  }

  [[nodiscard]] GlName get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GlName name_ = 0;
};

struct TextureKind {
  static GlName create(std::uint32_t target);  // GL_TEXTURE_2D, ...
  static void destroy(GlName name);
};
struct BufferKind {
  static GlName create();
  static void destroy(GlName name);
};
struct FramebufferKind {
  static GlName create();
  static void destroy(GlName name);
};
struct VertexArrayKind {
  static GlName create();
  static void destroy(GlName name);
};
struct ShaderKind {
  static GlName create(std::uint32_t stage);  // GL_VERTEX_SHADER, GL_FRAGMENT_SHADER
  static void destroy(GlName name);
};
struct ProgramKind {
  static GlName create();
  static void destroy(GlName name);
};

using GlTexture = GlHandle<TextureKind>;
using GlBuffer = GlHandle<BufferKind>;
using GlFramebuffer = GlHandle<FramebufferKind>;
using GlVertexArray = GlHandle<VertexArrayKind>;
using GlShader = GlHandle<ShaderKind>;
using GlProgramName = GlHandle<ProgramKind>;

}  // namespace pixelflex::devices
