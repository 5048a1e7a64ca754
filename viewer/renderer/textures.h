#pragma once

#include <cstdint>

#include "devices/display/gl_handle.h"
#include "devices/image/size.h"

namespace pixelflex::viewer {

/// The units that the warp's shaders read from.
enum TextureUnit : std::uint32_t { kDesktopUnit, kLightMapUnit, kResponseUnit, kCursorUnit, kNoiseUnit };

/// An empty GL_TEXTURE_2D of one level that is not filtered; `format` is GL's internal one. Needs a current context.
[[nodiscard]] devices::GlTexture makeTexture(std::uint32_t format, devices::Size size);

}  // namespace pixelflex::viewer
