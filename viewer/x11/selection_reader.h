#pragma once

#include <optional>
#include <string>

#include "viewer/x11/selection_atoms.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// Reads what is copied on the desktop. The session's thread.
class SelectionReader {
 public:
  /// `window` is ours and tells of its properties; all must outlive this.
  SelectionReader(const XConnection& connection, const SelectionAtoms& atoms, std::uint32_t window);

  void handle(const XEvent& event);
  /// UTF-8; each text once.
  [[nodiscard]] std::optional<std::string> takeText();

 private:
  void ask(std::uint32_t target, std::uint32_t time);
  void answered(bool given, std::uint32_t target, std::uint32_t time);
  void readPiece();
  void finish(std::string text);

  const XConnection& connection_;
  const SelectionAtoms& atoms_;
  std::uint32_t window_;
  int selectionEvent_ = 0;
  bool inPieces_ = false;
  std::string pieces_;
  bool latin1_ = false;  // what was asked for
  std::optional<std::string> text_;
};

}  // namespace pixelflex::viewer
