#pragma once

#include <string>

struct _XDisplay;

namespace pixelflex::testing {

/// A program that takes F9 for itself wherever the focus is, as window managers do with their shortcuts.
class XShortcut {
 public:
  /// Throws std::runtime_error.
  explicit XShortcut(const std::string& display);
  ~XShortcut();
  XShortcut(const XShortcut&) = delete;
  XShortcut& operator=(const XShortcut&) = delete;

  /// Since the last call.
  bool used();

 private:
  _XDisplay* display_;
};

}  // namespace pixelflex::testing
