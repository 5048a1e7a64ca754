#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include "devices/display/gl_context.h"

namespace pixelflex::devices {

struct HeadlessContext::Egl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

constexpr const char* kAdvice = "; install Mesa's EGL (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri)";

[[noreturn]] void fail(const std::string& what) {
  throw DisplayError(fmt::format("no headless graphics: {} (EGL error 0x{:04x}){}", what, eglGetError(), kAdvice));
}

bool hasClientExtension(const char* name) {
  return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

EGLDisplay openDisplay() {
  if (!epoxy_has_egl()) throw DisplayError(std::string("no headless graphics: libEGL.so.1 is missing") + kAdvice);
  if (hasClientExtension("EGL_MESA_platform_surfaceless")) {
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  }
  if (hasClientExtension("EGL_EXT_platform_device") && hasClientExtension("EGL_EXT_device_enumeration")) {
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (eglQueryDevicesEXT(1, &device, &count) == EGL_TRUE && count > 0) {
      return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    }
  }
  return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

EGLContext openContext(EGLDisplay display) {
  constexpr EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                    4,
                                    EGL_CONTEXT_MINOR_VERSION,
                                    5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                    EGL_CONTEXT_OPENGL_DEBUG,
                                    EGL_TRUE,
                                    EGL_NONE};
  constexpr EGLint kConfig[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("EGL cannot do desktop OpenGL");
  if (eglChooseConfig(display, kConfig, &config, 1, &count) != EGL_TRUE || count < 1) fail("no OpenGL configuration");
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kAttributes);
  if (context == EGL_NO_CONTEXT) fail("no OpenGL 4.5 core context");
  return context;
}

}  // namespace

HeadlessContext::HeadlessContext() : egl_(std::make_unique<Egl>()) {
  egl_->display = openDisplay();
  if (egl_->display == EGL_NO_DISPLAY || eglInitialize(egl_->display, nullptr, nullptr) != EGL_TRUE) {
    fail("EGL cannot be initialised");
  }
  if (!epoxy_has_egl_extension(egl_->display, "EGL_KHR_surfaceless_context")) fail("no surfaceless contexts");
  egl_->context = openContext(egl_->display);
  makeCurrent();
}

// The EGL display is the process's own and shared by every context, so it is not terminated here.
HeadlessContext::~HeadlessContext() {
  if (eglGetCurrentContext() == egl_->context) {
    eglMakeCurrent(egl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(egl_->display, egl_->context);
}

void HeadlessContext::makeCurrent() {
  if (eglMakeCurrent(egl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl_->context) != EGL_TRUE) {
    fail("the context cannot be made current");
  }
}

}  // namespace pixelflex::devices
