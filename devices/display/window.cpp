#include "devices/display/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "devices/display/glfw_error.h"
#include "devices/display/part_copy.h"

namespace pixelflex::devices {

struct Window::State {
  EventLoop* loop = nullptr;
  GLFWwindow* handle = nullptr;
  std::unique_ptr<Keysyms> keysyms;
  int unlockedCursor = GLFW_CURSOR_NORMAL;
  std::optional<glm::dvec2> lockedAt;  // set while the pointer is locked
  WindowHandlers handlers;
  GlFramebuffer reader;      // present() reads the shown texture through it
  bool copiesParts = false;  // see there

  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }

  /// Calls a handler from a C callback: nothing may be thrown through the C library.
  template <class Handler, class... Arguments>
  void call(const Handler& handler, Arguments... arguments) noexcept {
    if (!handler) return;
    try {
      handler(arguments...);
    } catch (...) {
      loop->keep(std::current_exception());
    }
  }
  /// With `all`, also those that the server has not told of yet: what was pressed before a button comes before it.
  void handKeys(bool all) noexcept {
    for (const KeyStroke& stroke : keysyms->take(all)) call(handlers.key, stroke);
  }
};

namespace {

void setHints(const WindowRequest& request) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  for (const int hint : {GLFW_RED_BITS, GLFW_GREEN_BITS, GLFW_BLUE_BITS}) glfwWindowHint(hint, request.bitsPerColour);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_DECORATED, request.borderless ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_FLOATING, request.borderless ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_RESIZABLE, request.borderless ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);  // until it is where it belongs
}

int buttonNumber(int button) {
  constexpr int kSideButtons = 8;  // X numbers the wheel 4 to 7
  switch (button) {
    case GLFW_MOUSE_BUTTON_LEFT:
      return 1;
    case GLFW_MOUSE_BUTTON_MIDDLE:
      return 2;
    case GLFW_MOUSE_BUTTON_RIGHT:
      return 3;
    default:
      return kSideButtons + button - GLFW_MOUSE_BUTTON_4;
  }
}

}  // namespace

Window::Window(EventLoop& loop, const WindowRequest& request, const Window* share) : state_(std::make_unique<State>()) {
  state_->loop = &loop;
  setHints(request);
  state_->handle = glfwCreateWindow(request.size.width, request.size.height, request.title.c_str(), nullptr,
                                    share != nullptr ? share->state_->handle : nullptr);
  if (state_->handle == nullptr) {
    throw DisplayError(fmt::format("cannot open the window '{}' of {}x{} with OpenGL 4.5: {}", request.title,
                                   request.size.width, request.size.height, lastGlfwError()));
  }
  glfwSetWindowUserPointer(state_->handle, state_.get());
  state_->keysyms = std::make_unique<Keysyms>(glfwGetX11Window(state_->handle));
  if (!request.showPointer) state_->unlockedCursor = GLFW_CURSOR_HIDDEN;
  glfwSetInputMode(state_->handle, GLFW_CURSOR, state_->unlockedCursor);
  if (request.at) glfwSetWindowPos(state_->handle, request.at->x, request.at->y);
  makeCurrent();
  glfwSwapInterval(request.paced ? 1 : 0);
  state_->reader = GlFramebuffer::create();
  state_->copiesParts = copiesParts();
  if (request.visible) glfwShowWindow(state_->handle);
  // A window manager may have moved it while it appeared.
  if (request.visible && request.at) glfwSetWindowPos(state_->handle, request.at->x, request.at->y);
}

Window::~Window() {
  state_->loop->removeTask(this);
  glfwMakeContextCurrent(state_->handle);
  state_->reader.reset();
  glfwMakeContextCurrent(nullptr);
  glfwDestroyWindow(state_->handle);
}

void Window::setHandlers(WindowHandlers handlers) {
  state_->handlers = std::move(handlers);
  GLFWwindow* const window = state_->handle;
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    auto& state = State::of(w);
    const glm::dvec2 position(x, y);
    if (!state.lockedAt) return state.call(state.handlers.pointer, position);
    state.call(state.handlers.motion, position - std::exchange(*state.lockedAt, position));
  });
  // GLFW tells of no motion to where the pointer was when it left.
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
    auto& state = State::of(w);
    if (entered == GLFW_FALSE || state.lockedAt) return;
    glm::dvec2 position;
    glfwGetCursorPos(w, &position.x, &position.y);
    state.call(state.handlers.pointer, position);
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int /*mods*/) {
    State::of(w).handKeys(true);
    State::of(w).call(State::of(w).handlers.button, buttonNumber(button), action != GLFW_RELEASE);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    State::of(w).call(State::of(w).handlers.scroll, glm::dvec2(x, y));
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    State::of(w).handKeys(true);
    State::of(w).call(State::of(w).handlers.focus, focused == GLFW_TRUE);
  });
  state_->loop->addTask(this, state_->keysyms->descriptor(), [state = state_.get()] { state->handKeys(false); });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { State::of(w).call(State::of(w).handlers.close); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { State::of(w).call(State::of(w).handlers.redraw); });
  glfwSetFramebufferSizeCallback(
      window, [](GLFWwindow* w, int /*width*/, int /*height*/) { State::of(w).call(State::of(w).handlers.redraw); });
}

void Window::makeCurrent() {
  glfwMakeContextCurrent(state_->handle);
  if (glfwGetCurrentContext() != state_->handle) {
    throw DisplayError(fmt::format("a window's graphics context is lost: {}", lastGlfwError()));
  }
}

Size Window::size() const {
  Size size;
  glfwGetFramebufferSize(state_->handle, &size.width, &size.height);
  return size;
}

int Window::bitsPerColour() {
  makeCurrent();
  constexpr GLuint kWindow = 0;
  int fewest = std::numeric_limits<int>::max();
  for (const GLenum colour : {GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
                              GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE}) {
    GLint bits = 0;
    glGetNamedFramebufferAttachmentParameteriv(kWindow, GL_BACK_LEFT, colour, &bits);
    fewest = std::min(fewest, bits);
  }
  return fewest;
}

glm::ivec2 Window::position() const {
  glm::ivec2 position;
  glfwGetWindowPos(state_->handle, &position.x, &position.y);
  return position;
}

void Window::lockPointer(bool locked) {
  if (locked == state_->lockedAt.has_value()) return;
  glfwSetInputMode(state_->handle, GLFW_CURSOR, locked ? GLFW_CURSOR_DISABLED : state_->unlockedCursor);
  state_->lockedAt.reset();
  if (!locked) return;
  glm::dvec2 position;
  glfwGetCursorPos(state_->handle, &position.x, &position.y);
  state_->lockedAt = position;
}

bool Window::grabKeyboard() {
  return state_->keysyms->grab();
}

void Window::releaseKeyboard() {
  state_->keysyms->letGo();
  state_->handKeys(false);
}

void Window::moveTo(glm::ivec2 position) {
  glfwSetWindowPos(state_->handle, position.x, position.y);
}

void Window::pace(bool paced) {
  makeCurrent();
  glfwSwapInterval(paced ? 1 : 0);
}

void Window::show(bool shown) {
  if (shown) {
    glfwShowWindow(state_->handle);
  } else {
    glfwHideWindow(state_->handle);
  }
}

void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(state_->handle, title.c_str());
}

void Window::present(GlName texture, Size textureSize) {
  makeCurrent();
  const auto window = size();
  if (window.width == 0 || window.height == 0) return;  // iconified
  glNamedFramebufferTexture(state_->reader.get(), GL_COLOR_ATTACHMENT0, texture, 0);
  glDisable(GL_SCISSOR_TEST);
  // Rows are turned over: a window's first row is its lowest.
  glBlitNamedFramebuffer(state_->reader.get(), 0, 0, 0, textureSize.width, textureSize.height, 0, window.height,
                         window.width, 0, GL_COLOR_BUFFER_BIT, window == textureSize ? GL_NEAREST : GL_LINEAR);
  swap();
}

void Window::present(GlName texture, Size textureSize, std::span<const Part> parts) {
  std::int64_t area = 0;
  for (const auto& part : parts) area += part.size.area();
  const bool whole = !state_->copiesParts || size() != textureSize || 2 * area > textureSize.area();
  if (whole) return present(texture, textureSize);
  makeCurrent();
  glNamedFramebufferTexture(state_->reader.get(), GL_COLOR_ATTACHMENT0, texture, 0);
  glDisable(GL_SCISSOR_TEST);
  for (const auto& [at, size] : parts) {
    const int right = at.x + size.width;
    const int below = at.y + size.height;
    const int bottom = textureSize.height - below;
    glBlitNamedFramebuffer(state_->reader.get(), 0, at.x, at.y, right, below, at.x, textureSize.height - at.y, right,
                           bottom, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    copyPart(at.x, bottom, size.width, size.height);
  }
}

void Window::swap() {
  glfwSwapBuffers(state_->handle);
}

}  // namespace pixelflex::devices
