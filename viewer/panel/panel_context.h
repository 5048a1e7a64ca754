#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewer/control/wall_console.h"
#include "viewer/panel/widget_map.h"

namespace pixelflex::viewer {

/// What a person has chosen in the panel.
struct PanelChoice {
  std::set<std::string> projectors;
  std::string tab = "map";                              // to be opened in the next frame; empty: stay
  std::optional<std::vector<std::string>> calibration;  // to be begun as soon as the live picture has let the camera go
  int calibrationJob = 0;                               // whose end opens the report; 0: none
  bool opensReport = true;
};

/// What every part of the panel works with during a frame. Main thread.
struct PanelContext {
  WallConsole& console;
  std::shared_ptr<const WallSnapshot> wall;
  PanelChoice& choice;
  WidgetMap& map;

  /// Runs what may be refused; the refusal goes into the log.
  void attempt(const std::function<void()>& action) const;
  /// The number of the job; 0 when it was refused.
  int device(const std::string& names, const std::vector<std::string>& steps) const;

  /// The chosen projectors, in the wall's order.
  [[nodiscard]] std::vector<std::string> chosen() const;
  /// The devices of the chosen projectors: their mirrors, or their controls.
  [[nodiscard]] std::vector<const DeviceState*> chosenDevices(bool mirrors) const;
  /// As a command takes it: "all", or names with commas.
  [[nodiscard]] std::string namesOf(const std::vector<const DeviceState*>& devices) const;
  [[nodiscard]] const ConsoleJob* longJob() const;  // that runs; null: none
};

}  // namespace pixelflex::viewer
