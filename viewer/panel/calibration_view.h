#pragma once

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// Buttons for both calibrations, how far they are, what they said, and the report. Main thread.
class CalibrationView {
 public:
  void draw(PanelContext& panel);
  /// The one that was chosen.
  static void begin(PanelContext& panel);
  /// Opens the report when a calibration begun here has ended well; every frame.
  static void update(PanelContext& panel);

 private:
  static void drawButtons(PanelContext& panel);
  static void drawState(const PanelContext& panel);
  static void drawLast(PanelContext& panel);
};

/// The running long job with its progress and a button that cancels it, in one line; nothing when none runs.
void drawLongJob(PanelContext& panel, float width);

}  // namespace pixelflex::viewer
