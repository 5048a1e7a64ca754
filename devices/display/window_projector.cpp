#include "devices/display/window_projector.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pixelflex::devices {
namespace {

std::vector<std::uint8_t> asColour(const Image8& frame) {
  std::vector<std::uint8_t> colour;
  if (frame.channels() == 3) {
    colour.assign(frame.samples().begin(), frame.samples().end());
  } else {
    for (const auto sample : frame.samples()) colour.insert(colour.end(), 3, sample);
  }
  return colour;
}

}  // namespace

WindowProjector::WindowProjector(std::string name, EventLoop& loop, Size resolution, glm::ivec2 at)
    : name_(std::move(name)),
      loop_(loop),
      resolution_(resolution),
      window_(loop,
              {.title = "PixelFlex " + name_, .size = resolution, .at = at, .borderless = true, .showPointer = false}),
      picture_(GlTexture::create(GL_TEXTURE_2D)) {
  glTextureStorage2D(picture_.get(), 1, GL_RGBA8, resolution.width, resolution.height);
  window_.setHandlers({.redraw = [this] { present(); }});
  blank();
}

WindowProjector::~WindowProjector() {
  window_.setHandlers({});
  window_.makeCurrent();  // the picture's texture is its
}

void WindowProjector::show(const Image8& frame) {
  if (frame.size() != resolution_ || (frame.channels() != 1 && frame.channels() != 3)) {
    throw std::invalid_argument(fmt::format("projector '{}' shows {}x{} pixels, grey or colour, not {}x{}x{}", name_,
                                            resolution_.width, resolution_.height, frame.width(), frame.height(),
                                            frame.channels()));
  }
  const auto colour = asColour(frame);
  window_.makeCurrent();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(picture_.get(), 0, 0, 0, resolution_.width, resolution_.height, GL_RGB, GL_UNSIGNED_BYTE,
                      colour.data());
  present();
  loop_.poll();
}

void WindowProjector::blank() {
  window_.makeCurrent();
  glClearTexImage(picture_.get(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  present();
  loop_.poll();
}

void WindowProjector::present() {
  window_.present(picture_.get(), resolution_);
  glFinish();
}

}  // namespace pixelflex::devices
