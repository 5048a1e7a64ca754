#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viewer/panel/panel_context.h"
#include "viewer/panel/setting_rows.h"
#include "viewer/panel/test_pictures.h"

namespace pixelflex::viewer {

/// Everything about the chosen projectors: their mirrors, pictures and lenses, test pictures, and what is wrong.
class DevicePane {
 public:
  void draw(PanelContext& panel, TestPictures& pictures);

  /// As the buttons: so many jog steps of the chosen mirrors.
  void jog(const PanelContext& panel, int pan, int tilt) const;

 private:
  void drawTroubles(const PanelContext& panel) const;
  void drawMirror(PanelContext& panel);
  void drawJog(PanelContext& panel, const std::string& names);
  void drawSettings(PanelContext& panel, const std::string& heading, const std::vector<std::string>& settings);
  void drawReadings(const PanelContext& panel) const;
  void drawTestPictures(PanelContext& panel, TestPictures& pictures);

  SettingRows rows_;
  std::size_t jogStep_ = 2;
};

}  // namespace pixelflex::viewer
