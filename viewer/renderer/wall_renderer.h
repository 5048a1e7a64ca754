#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/renderer/output.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/tiles/frame_belt.h"

namespace pixelflex::viewer {

/// What has been done since the renderer was made. Times are of the calling thread's clock and include waiting for
/// the GPU in `draw`.
struct RenderStats {
  std::uint64_t bytesUploaded = 0;
  std::uint64_t boxesUploaded = 0;
  std::uint64_t frames = 0;  // calls of draw() that drew something
  std::uint64_t outputsDrawn = 0;
  std::uint64_t pixelsDrawn = 0;
  std::chrono::nanoseconds uploadTime{0};
  std::chrono::nanoseconds markTime{0};
  std::chrono::nanoseconds drawTime{0};
  std::chrono::nanoseconds readTime{0};
};

struct RendererOptions {
  /// For measurements: desktop and frames in RGBA32F, the sampled value comes out as it is. A desktop that holds its
  /// own coordinates comes out as the coordinates that each projector pixel shows.
  bool measure = false;
  int bitsPerColour = 8;  // of the frames: 8 or 10; what is dithered is rounded to these
  UploadPath upload;      // see fastestUpload()
};

/// Draws the desktop for every projector of one GPU. One thread, the context's. Each function makes the context current
/// when it has something to do there.
class WallRenderer {
 public:
  /// The context must outlive the renderer.
  explicit WallRenderer(devices::GlContext& context, RendererOptions options = {});
  ~WallRenderer();
  WallRenderer(const WallRenderer&) = delete;
  WallRenderer& operator=(const WallRenderer&) = delete;

  /// What is drawn from now on; every output is marked whole. All plans show the same desktop. True when the desktop's
  /// pixels are lost because its size is another (or this is the first call): ask the server for all of it. Throws
  /// RendererError and keeps the old plans when one is not sound; a desktop too large for the GPU leaves no plans.
  bool setPlans(const std::vector<OutputPlan>& plans);

  /// Where a batch's pixels had best lie; null: anywhere. Belongs to the renderer.
  [[nodiscard]] std::pmr::memory_resource* uploadMemory() { return uploadMemory_.get(); }
  /// Takes a part of an update: uploads its boxes and marks the projector pixels that show them. Boxes may reach out of
  /// the desktop. While an update is incomplete draw() waits. Needs plans.
  void upload(const Batch& batch);
  /// For measurements: a whole desktop of four floats a pixel.
  void uploadDesktop(const devices::ImageF& desktop);

  /// A whole desktop that was drawn on the GPU: GL_TEXTURE_2D of its size, RGBA8 (RGBA32F for measurements), row 0 at
  /// the top. It must be finished, and is not needed afterwards.
  void copyDesktop(devices::GlName picture);

  /// The pointer, drawn on top of the desktop: four channels, colour not multiplied by alpha; an empty image hides it.
  void setCursor(const devices::Image8& image, glm::ivec2 hotspot);
  /// To a desktop pixel.
  void moveCursor(glm::ivec2 position);
  void showCursor(bool shown);

  /// How much of the desktop's light is shown, 0 to 1; 1 leaves every pixel as it is. Black levels stay.
  void setBrightness(float brightness);

  /// Lays text over an output's frame, see textPanel(); an empty image takes it away. Stays with the output's number.
  void setPanel(std::size_t output, const devices::Image8& panel);
  /// Borders around what is drawn from here on, which fade with each fadeDamage().
  void showDamage(bool shown);
  /// Marks what that changes.
  void fadeDamage();
  /// There are borders.
  [[nodiscard]] bool fading() const;

  void markAll();
  /// Something is marked and no update is half way in: draw() would draw.
  [[nodiscard]] bool needsDraw() const;
  /// Draws the marked parts and waits until they are drawn: the numbers of the outputs that changed, none when nothing
  /// was marked or when an update is half way in.
  std::vector<std::size_t> draw();

  [[nodiscard]] std::size_t outputCount() const { return outputs_.size(); }
  /// Numbers are those of the plans.
  [[nodiscard]] const std::string& outputName(std::size_t output) const;
  [[nodiscard]] devices::Size outputResolution(std::size_t output) const;
  /// The parts that the last draw() has drawn again, in pixels of the frame.
  [[nodiscard]] const Region& outputDrawn(std::size_t output) const;
  /// The frame as GL_TEXTURE_2D with row 0 at the top, for a window or the room view; valid until setPlans.
  [[nodiscard]] devices::GlName outputTexture(std::size_t output) const;
  /// The frame as drawn last, red, green, blue, top row first.
  [[nodiscard]] devices::Image8 readOutput(std::size_t output);
  /// The same in as many bits as it has, the highest code as 65535.
  [[nodiscard]] devices::Image16 readOutput16(std::size_t output);
  /// Four channels; with `measure` the sampled value and in alpha 1 where the mesh is, else codes with the highest
  /// as 1.
  [[nodiscard]] devices::ImageF readOutputFloat(std::size_t output);
  /// The desktop as uploaded, without the pointer.
  [[nodiscard]] devices::Image8 readDesktop();

  [[nodiscard]] RenderStats stats() const;

 private:
  void markWhere(const Box& desktopBox);
  template <class Change>
  void changeCursor(const Change& change);

  devices::GlContext& context_;
  RendererOptions options_;
  WarpPrograms programs_;
  std::unique_ptr<UploadMemory> uploadMemory_;  // before the desktop, which reads from it
  std::optional<DesktopTexture> desktop_;
  std::vector<Output> outputs_;
  Cursor cursor_;
  float brightness_ = 1;
  bool showsDamage_ = false;
  std::size_t panelOutput_ = 0;
  devices::Image8 panel_;
  bool updateOpen_ = false;
  RenderStats stats_;
  std::uint64_t bytesOfOldDesktops_ = 0;
};

}  // namespace pixelflex::viewer
