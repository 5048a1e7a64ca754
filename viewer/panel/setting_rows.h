#pragma once

#include <map>
#include <string>
#include <vector>

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// A setting that several devices share, as one row of controls. What is set goes to all of them at once.
class SettingRows {
 public:
  /// Of those `devices` that have the setting; nothing when none has.
  void draw(PanelContext& panel, const std::vector<const DeviceState*>& devices, const std::string& setting);

 private:
  struct Shared;
  void drawNumber(PanelContext& panel, const Shared& shared);
  void drawWords(PanelContext& panel, const Shared& shared);
  void drawSteps(PanelContext& panel, const Shared& shared);
  void set(PanelContext& panel, const Shared& shared, const std::string& value);

  std::string edited_;      // the setting whose slider is held
  double editedValue_ = 0;  // where it is held
  /// What was asked for last, until that job has ended: shown in the stead of what the device still says.
  struct Wish {
    int job = 0;
    std::string value;
  };
  std::map<std::string, Wish> wishes_;  // by devices and setting
};

}  // namespace pixelflex::viewer
