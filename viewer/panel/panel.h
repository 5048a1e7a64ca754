#pragma once

#include <filesystem>
#include <string>

#include "devices/display/keysyms.h"
#include "viewer/panel/calibration_view.h"
#include "viewer/panel/camera_feed.h"
#include "viewer/panel/camera_view.h"
#include "viewer/panel/device_list.h"
#include "viewer/panel/device_pane.h"
#include "viewer/panel/log_view.h"
#include "viewer/panel/map_view.h"
#include "viewer/panel/preset_view.h"
#include "viewer/panel/test_pictures.h"

namespace pixelflex::viewer {

struct PanelOptions {
  std::filesystem::path programs;  // where the other programs are
  std::filesystem::path controls;  // the map of controls is written here; empty: nowhere
  PanelChoice choice = {};         // to begin with
};

/// All of the control panel in the toolkit's current frame. Main thread, with the window's GL context.
class Panel {
 public:
  Panel(WallConsole& console, const PanelOptions& options);

  void draw();
  /// Before the window's context goes.
  void releaseGraphics() { camera_.releaseGraphics(); }
  /// Whether a key was one of the panel's own: F12 stops all, Alt with an arrow aims the chosen mirrors.
  bool shortcut(const devices::KeyStroke& stroke);
  /// Another one: there is something new to be drawn.
  [[nodiscard]] std::uint64_t revision() const;
  /// Something is being waited for that no revision tells.
  [[nodiscard]] bool isPending() const { return choice_.calibration.has_value(); }
  /// The camera is looked at, and its first picture is still to come.
  [[nodiscard]] bool awaitsCamera() const { return cameraOpen_ && feed_.latest()->number == 0; }

 private:
  [[nodiscard]] PanelContext context();
  void updateCamera(PanelContext& panel);
  void drawTop(PanelContext& panel);
  void drawMiddle(PanelContext& panel);
  void drawTab(PanelContext& panel, const char* name, const char* label);

  WallConsole& console_;
  PanelChoice choice_;
  WidgetMap controls_;
  CameraFeed feed_;
  TestPictures pictures_;
  DeviceList list_;
  DevicePane pane_;
  MapView map_;
  CameraView camera_;
  CalibrationView calibration_;
  PresetView presets_;
  LogView log_;
  bool alt_ = false;
  bool cameraOpen_ = false;
};

}  // namespace pixelflex::viewer
