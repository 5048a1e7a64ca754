#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/model/model_renderer.h"
#include "viewer/plan/model_arrangement.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {

/// A model on all projectors of a wall, in one pass or two. One thread, the context's.
class ModelWall {
 public:
  /// Context and wall must outlive this. Throws PlanError, RendererError.
  ModelWall(devices::GlContext& context, const WallPlan& wall, ModelWallOptions options);

  /// The same projectors, calibrated anew; the wall must outlive this, or the next one. Throws PlanError,
  /// RendererError, and then keeps the old one.
  void setWall(const WallPlan& wall);
  void setScene(Scene scene) { scene_.setScene(std::move(scene)); }
  void setView(const ModelView& view) { scene_.setView(view); }
  [[nodiscard]] const Bounds3& bounds() const { return scene_.bounds(); }

  /// Draws what has changed; false when nothing had.
  bool draw();
  /// There is a picture.
  [[nodiscard]] bool drawn() const { return drawn_; }

  /// Numbers are those of WallPlan::projectors().
  [[nodiscard]] std::size_t projectorCount() const { return arranged_.places.size(); }
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
  [[nodiscard]] std::size_t desktopCount() const { return scene_.outputCount() - arranged_.firstDesktop; }
  [[nodiscard]] devices::GlName desktopTexture(std::size_t eye) const;
  [[nodiscard]] devices::Image8 readDesktop(std::size_t eye) { return scene_.readOutput(arranged_.firstDesktop + eye); }
  [[nodiscard]] devices::ImageF readDesktopFloat(std::size_t eye) {
    return scene_.readOutputFloat(arranged_.firstDesktop + eye);
  }

  /// How far one pass is from the calibrated lens, whatever is shown.
  [[nodiscard]] const std::vector<OnePassFit>& fits() const { return arranged_.fits; }

 private:
  devices::GlContext& context_;
  ModelWallOptions options_;
  const WallPlan* wall_ = nullptr;
  ModelRenderer scene_;
  ModelArrangement arranged_;
  std::vector<std::unique_ptr<WallRenderer>> warps_;  // of the arrangement's
  bool drawn_ = false;
};

}  // namespace pixelflex::viewer
