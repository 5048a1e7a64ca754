#pragma once

#include <cstdint>

#include "devices/display/gl_handle.h"
#include "viewer/panel/camera_feed.h"
#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// The live picture of the camera with the fiducials that are found in it. Main thread, with a GL context.
class CameraView {
 public:
  explicit CameraView(CameraFeed& feed) : feed_(feed) {}
  void draw(PanelContext& panel);
  /// While there is still a context.
  void releaseGraphics() {
    texture_ = {};
    uploaded_ = 0;
  }

 private:
  void upload(const CameraPicture& picture);
  void drawMarkers(const PanelContext& panel, const CameraPicture& picture, glm::vec2 at, float scale) const;

  CameraFeed& feed_;
  std::uint64_t uploaded_ = 0;
  devices::GlTexture texture_;
};

}  // namespace pixelflex::viewer
