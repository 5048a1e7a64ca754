#pragma once

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// Every projector with the states of its devices, to choose from: one, several with Ctrl, a row of them with Shift.
class DeviceList {
 public:
  void draw(PanelContext& panel);

 private:
  void drawRow(PanelContext& panel, std::size_t index);
  void choose(PanelContext& panel, std::size_t index);

  std::size_t last_ = 0;  // chosen without Shift
};

}  // namespace pixelflex::viewer
