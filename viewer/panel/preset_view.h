#pragma once

#include <array>
#include <string>

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// The wall's presets: to save, look at, restore and delete. Main thread.
class PresetView {
 public:
  void draw(PanelContext& panel);

 private:
  void drawSave(PanelContext& panel);
  void drawList(PanelContext& panel);
  void drawPreset(PanelContext& panel, const PresetInfo& preset);
  void drawDelete(PanelContext& panel);
  static void drawLast(const PanelContext& panel);

  std::array<char, 64> name_{};
  std::string deleting_;  // being asked about
  bool verifies_ = false;
};

}  // namespace pixelflex::viewer
