#pragma once

#include "devices/display/gl_handle.h"
#include "devices/image/image.h"

namespace pixelflex::viewer {

/// A picture of sRGB codes on the GPU, decoded before it is filtered, in all levels. `weighted`: its light is
/// multiplied by its fourth channel, so that what cannot be seen has no part in the filter. Needs a current context.
/// Throws RendererError when it does not fit.
[[nodiscard]] devices::GlTexture pictureTexture(devices::Image8 picture, bool weighted);

}  // namespace pixelflex::viewer
