#include "viewer/renderer/frame_overlay.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

constexpr int kMargin = 16;  // of the panel
constexpr int kThickness = 2;
constexpr std::size_t kMostBorders = 32;
constexpr glm::vec3 kBorderColour{1.0F, 0.2F, 0.8F};  // hardly any desktop has it

// May overlap where the box is thin; empty ones are of no harm.
std::array<Box, 4> edgesOf(const Box& box) {
  const int inTop = std::min(box.top + kThickness, box.bottom);
  const int inBottom = std::max(box.bottom - kThickness, inTop);
  const int inLeft = std::min(box.left + kThickness, box.right);
  const int inRight = std::max(box.right - kThickness, inLeft);
  return {{{box.left, box.top, box.right, inTop},
           {box.left, inBottom, box.right, box.bottom},
           {box.left, inTop, inLeft, inBottom},
           {inRight, inTop, box.right, inBottom}}};
}

void markEdges(const Box& box, Region& stale) {
  for (const Box& edge : edgesOf(box)) {
    if (!edge.empty()) stale.add(edge);
  }
}

void fillWithin(const Box& part, const Box& box) {
  const Box both = intersect(part, box);
  if (both.empty()) return;
  glScissor(both.left, both.top, both.width(), both.height());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

void FrameOverlay::setPanel(const devices::Image8& panel, Region& stale) {
  if (!panelBox_.empty()) stale.add(panelBox_);
  panel_.reset();
  panelBox_ = {};
  if (panel.empty()) return;
  assert(panel.channels() == 4);
  panel_ = makeTexture(GL_RGBA8, panel.size());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(panel_.get(), 0, 0, 0, panel.width(), panel.height(), GL_RGBA, GL_UNSIGNED_BYTE,
                      panel.samples().data());
  panelBox_ = {kMargin, kMargin, kMargin + panel.width(), kMargin + panel.height()};
  stale.add(panelBox_);
}

void FrameOverlay::showDamage(bool shown, Region& stale) {
  showsDamage_ = shown;
  if (shown) return;
  for (const Border& border : borders_) markEdges(border.box, stale);
  borders_.clear();
}

void FrameOverlay::note(const Region& drawn, Region& stale) {
  if (!showsDamage_) return;
  for (const Box& box : drawn.boxes()) {
    std::erase_if(borders_, [&box](const Border& border) { return border.box == box; });
    if (borders_.size() == kMostBorders) {
      markEdges(borders_.front().box, stale);
      borders_.erase(borders_.begin());
    }
    borders_.push_back({box});
  }
}

void FrameOverlay::fade(Region& stale) {
  for (Border& border : borders_) {
    --border.stepsLeft;
    markEdges(border.box, stale);
  }
  std::erase_if(borders_, [](const Border& border) { return border.stepsLeft <= 0; });
}

void FrameOverlay::draw(const Box& part, WarpPrograms& programs) const {
  if (panelBox_.empty() && borders_.empty()) return;
  const auto& program = programs.overlay();
  program.use();
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  program.set("image", static_cast<int>(kCursorUnit));
  program.set("plain", 1);
  for (const Border& border : borders_) {
    const float opacity = static_cast<float>(border.stepsLeft) / kSteps;
    program.set("colour", glm::vec4(kBorderColour, opacity));
    for (const Box& edge : edgesOf(border.box)) fillWithin(part, edge);
  }
  if (!panelBox_.empty()) {
    program.set("plain", 0);
    program.set("imageAt", glm::ivec2(panelBox_.left, panelBox_.top));
    glBindTextureUnit(kCursorUnit, panel_.get());
    fillWithin(part, panelBox_);
  }
  glDisable(GL_BLEND);
}

}  // namespace pixelflex::viewer
