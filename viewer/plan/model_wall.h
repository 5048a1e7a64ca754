#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/model/model_renderer.h"
#include "viewer/plan/close_up.h"
#include "viewer/plan/one_pass_fit.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {

struct ModelWallOptions {
  int passes = 1;                      // 2: drawn once for the desktop, which then goes the desktop's own way, and
                                       // once more for each projector that is much denser
  Features features = Features::kAll;  // of one pass
  bool lensAtVertices = false;         // one pass, for finely tessellated models
  bool desktop = false;                // one pass: the desktop is drawn as well, to look at
  bool bothEyes = false;               // of the desktop, where no projector asks for them
  ModelOptions model;
};

/// A model on all projectors of a wall, in one pass or two. One thread, the context's.
class ModelWall {
 public:
  /// Context and wall must outlive this. Reads the projectors' light from `folder`. Throws PlanError, RendererError and
  /// what WallPlan throws.
  ModelWall(devices::GlContext& context, const WallPlan& wall, const std::filesystem::path& folder,
            ModelWallOptions options);

  void setScene(Scene scene) { scene_->setScene(std::move(scene)); }
  void setView(const ModelView& view) { scene_->setView(view); }
  [[nodiscard]] const Bounds3& bounds() const { return scene_->bounds(); }

  /// Draws what has changed; false when nothing had.
  bool draw();
  /// There is a picture.
  [[nodiscard]] bool drawn() const { return drawn_; }

  /// Numbers are those of WallPlan::projectors().
  [[nodiscard]] std::size_t projectorCount() const { return places_.size(); }
  [[nodiscard]] const std::string& name(std::size_t projector) const;
  [[nodiscard]] devices::Size resolution(std::size_t projector) const;
  /// GL_TEXTURE_2D, row 0 at the top.
  [[nodiscard]] devices::GlName texture(std::size_t projector) const;
  [[nodiscard]] devices::Image8 read(std::size_t projector);
  [[nodiscard]] devices::ImageF readFloat(std::size_t projector);
  /// What one pass sent for a projector, or the first of two for the desktop or the projector's close-up.
  [[nodiscard]] DrawnParts drawnParts(std::size_t projector) const;

  /// The desktop's pictures, where there are any: that of the middle, or the left eye's, the right one's and perhaps
  /// that of the middle.
  [[nodiscard]] std::size_t desktopCount() const { return scene_->outputCount() - firstDesktop_; }
  [[nodiscard]] devices::GlName desktopTexture(std::size_t eye) const;
  [[nodiscard]] devices::Image8 readDesktop(std::size_t eye) { return scene_->readOutput(firstDesktop_ + eye); }
  [[nodiscard]] devices::ImageF readDesktopFloat(std::size_t eye) {
    return scene_->readOutputFloat(firstDesktop_ + eye);
  }

  /// How far one pass is from the calibrated lens, whatever is shown.
  [[nodiscard]] const std::vector<OnePassFit>& fits() const { return fits_; }

 private:
  struct Place {
    std::size_t renderer = 0;  // of two passes: which of warps_
    std::size_t output = 0;
  };
  /// The second pass for one eye's picture of the desktop, or for a dense projector's close-up.
  struct Warp {
    std::size_t picture = 0;  // output of scene_
    std::unique_ptr<WallRenderer> renderer;
  };
  void addProjectors(const std::filesystem::path& folder, std::vector<ModelOutput>& outputs);
  void addCloseUps(std::vector<ModelOutput>& outputs);
  void addDesktops(std::vector<ModelOutput>& outputs);
  [[nodiscard]] ModelOutput pictureFor(Eye eye, devices::Size resolution) const;
  void makeWarps(devices::GlContext& context);
  void addWarp(devices::GlContext& context, std::size_t picture, const std::vector<OutputPlan>& plans);

  const WallPlan& wall_;
  ModelWallOptions options_;
  std::vector<Eye> eyes_;  // of each projector
  std::vector<OnePassFit> fits_;
  std::vector<std::optional<CloseUp>> closeUps_;  // of two passes; they are scene_'s first outputs
  std::vector<Eye> desktops_;
  std::size_t firstDesktop_ = 0;
  std::unique_ptr<ModelRenderer> scene_;
  std::vector<Warp> warps_;
  std::vector<Place> places_;
  bool drawn_ = false;
};

}  // namespace pixelflex::viewer
