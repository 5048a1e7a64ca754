#include "viewer/panel/panel_window.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "devices/display/display_error.h"
#include "viewer/panel/panel_style.h"

namespace pixelflex::viewer {
namespace {

// Menus and tool tips take some frames to find their size.
constexpr int kFramesAfterInput = 4;
// Hints come when the pointer rests.
constexpr std::chrono::milliseconds kRest{600};

}  // namespace

PanelWindow::PanelWindow(devices::EventLoop& loop, const std::string& title, devices::Size size, float scale,
                         std::function<bool(const devices::KeyStroke& stroke)> shortcut)
    : window_(loop, {.title = title, .size = size, .paced = true}), shortcut_(std::move(shortcut)) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  PanelInput::begin();
  applyPanelStyle(scale);
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) {
    throw devices::DisplayError("the panel's window: the toolkit finds no OpenGL library (libGL.so.1)");
  }
  window_.setHandlers({.pointer =
                           [this](glm::dvec2 position) {
                             input_.movePointer(position);
                             touch();
                           },
                       .button =
                           [this](int button, bool pressed) {
                             input_.pressButton(button, pressed);
                             touch();
                           },
                       .scroll =
                           [this](glm::dvec2 steps) {
                             input_.scroll(steps);
                             touch();
                           },
                       .key =
                           [this](const devices::KeyStroke& stroke) {
                             if (!shortcut_(stroke)) input_.pressKey(stroke);
                             touch();
                           },
                       .close = [this] { closed_ = true; },
                       .redraw = [this] { touch(); }});
  touch();
}

PanelWindow::~PanelWindow() {
  try {
    window_.makeCurrent();
  } catch (const devices::DisplayError&) {
    // The context is gone and its objects with it; deleting their names is then without effect.
  }
  ImGui_ImplOpenGL3_Shutdown();
}

PanelWindow::Toolkit::Toolkit() {
  ImGui::CreateContext();
}

PanelWindow::Toolkit::~Toolkit() {
  ImGui::DestroyContext();
}

bool PanelWindow::needsFrame() const {
  const bool rests = !rested_ && std::chrono::steady_clock::now() - touched_ > kRest;
  return framesLeft_ > 0 || input_.waits() || rests;
}

void PanelWindow::touch() {
  framesLeft_ = kFramesAfterInput;
  touched_ = std::chrono::steady_clock::now();
  rested_ = false;
}

void PanelWindow::frame(const std::function<void()>& draw) {
  window_.makeCurrent();
  const devices::Size size = window_.size();
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<float> passed = now - std::exchange(drawn_, now);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
  io.DeltaTime = std::clamp(passed.count(), 0.001F, 1.0F);
  rested_ = rested_ || now - touched_ > kRest;
  framesLeft_ = std::max(0, framesLeft_ - 1);
  input_.apply();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  draw();
  ImGui::Render();
  render();
  window_.swap();
}

void PanelWindow::render() {
  const devices::Size size = window_.size();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.width, size.height);
  const ImVec4 back = ImGui::ColorConvertU32ToFloat4(PanelColours::kBack);
  glClearColor(back.x, back.y, back.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

devices::Image8 PanelWindow::picture() {
  window_.makeCurrent();
  const devices::Size size = window_.size();
  devices::Image8 image(size, 3);
  glReadBuffer(GL_BACK);
  render();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, image.samples().data());
  for (int y = 0; y < size.height / 2; ++y) std::ranges::swap_ranges(image.row(y), image.row(size.height - 1 - y));
  return image;
}

}  // namespace pixelflex::viewer
