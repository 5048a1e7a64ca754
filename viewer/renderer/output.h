#pragma once

#include <cstdint>

#include "devices/display/gl_handle.h"
#include "viewer/renderer/cursor.h"
#include "viewer/renderer/desktop_texture.h"
#include "viewer/renderer/frame_overlay.h"
#include "viewer/renderer/mesh_footprint.h"
#include "viewer/renderer/output_light.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/renderer/warp_programs.h"
#include "viewer/tiles/region.h"

namespace pixelflex::viewer {

enum class FrameFormat {
  kRgba8,
  kRgb10,    // ten bits for each colour
  kRgba32F,  // for measurements: what was sampled, alpha 1 where the mesh is
};

/// One projector's picture: a frame that is kept, and the parts of it that are out of date. Needs its context current
/// for everything but mark().
class Output {
 public:
  /// Throws RendererError when the plan is not sound.
  Output(const OutputPlan& plan, const TileLayout& layout, FrameFormat format);

  /// The projector pixels that read these desktop pixels will be drawn again.
  void mark(const Box& desktopBox);
  void markAll();
  [[nodiscard]] bool marked() const { return !marked_.empty() || !stale_.empty(); }
  /// What the last draw() has drawn.
  [[nodiscard]] const Region& drawn() const { return drawn_; }

  /// See FrameOverlay: what lies over the frame.
  void setPanel(const devices::Image8& panel) { overlay_.setPanel(panel, stale_); }
  void showDamage(bool shown) { overlay_.showDamage(shown, stale_); }
  void fadeDamage() { overlay_.fade(stale_); }
  [[nodiscard]] bool fading() const { return overlay_.fading(); }

  /// How much of the desktop's light is shown, 0 to 1, from the next draw() on. Marks the whole frame.
  void setBrightness(float brightness);

  /// Draws the marked parts and nothing else; the number of pixels drawn.
  std::uint64_t draw(DesktopTexture& desktop, const Cursor& cursor, WarpPrograms& programs);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] devices::Size resolution() const { return resolution_; }
  /// GL_TEXTURE_2D, row 0 at the top of the picture.
  [[nodiscard]] devices::GlName texture() const { return frame_.get(); }
  /// The frame, red, green, blue, top row first.
  [[nodiscard]] devices::Image8 read() const;
  /// The same with the highest code as 65535.
  [[nodiscard]] devices::Image16 read16() const;
  /// Four channels.
  [[nodiscard]] devices::ImageF readFloat() const;

 private:
  [[nodiscard]] Box touchedBy(const Box& desktopBox) const;
  void makeFrame();
  void makeMesh();
  void chooseFilter(const OutputPlan& plan);
  void drawBox(const Box& box, const DesktopTexture& desktop, const Cursor& cursor, WarpPrograms& programs) const;
  void setUniforms(const devices::GlProgram& program, const DesktopTexture& desktop, const Cursor& cursor) const;
  void drawMesh(const Box& box) const;

  std::string name_;
  devices::Size resolution_;
  devices::Size desktop_;
  FrameFormat format_ = FrameFormat::kRgba8;
  WarpVariant variant_;
  glm::ivec2 exactAt_{0, 0};
  Box exactShown_;
  float brightness_ = 1;
  OutputLight light_;
  MeshFootprint footprint_;
  Region marked_;
  Region stale_;  // marked because of the overlay alone
  Region drawn_;
  FrameOverlay overlay_;
  devices::GlTexture frame_;
  devices::GlFramebuffer framebuffer_;
  devices::GlBuffer vertices_;
  devices::GlVertexArray vertexArray_;
};

}  // namespace pixelflex::viewer
