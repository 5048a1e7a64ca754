#pragma once

#include <filesystem>
#include <string>

namespace pixelflex::viewer {

/// Where each control of the panel is, for programs that drive it: "NAME X Y WIDTH HEIGHT", window pixels, one a line.
/// Main thread.
class WidgetMap {
 public:
  /// Empty: nothing is kept.
  explicit WidgetMap(std::filesystem::path file) : file_(std::move(file)) {}

  /// The control that the toolkit has just been given, unless it is out of sight.
  void add(const std::string& name);
  /// A part of the window.
  void add(const std::string& name, float left, float top, float right, float bottom);
  /// A frame is complete: writes the file where something has changed.
  void finish();

 private:
  std::filesystem::path file_;
  std::string lines_;
  std::string written_;
};

}  // namespace pixelflex::viewer
