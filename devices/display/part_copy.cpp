#include "devices/display/part_copy.h"

#include <epoxy/gl.h>
#include <epoxy/glx.h>

#include <string_view>

namespace pixelflex::devices {

bool copiesParts() {
  Display* const display = glXGetCurrentDisplay();
  if (display == nullptr) return false;
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name != nullptr ? name : "";
  const bool software = renderer.starts_with("llvmpipe") || renderer.starts_with("softpipe");
  return software && epoxy_has_glx_extension(display, XDefaultScreen(display), "GLX_MESA_copy_sub_buffer");
}

void copyPart(int left, int bottom, int width, int height) {
  Display* const display = glXGetCurrentDisplay();
  glXCopySubBufferMESA(display, glXGetCurrentDrawable(), left, bottom, width, height);
  XFlush(display);
}

}  // namespace pixelflex::devices
