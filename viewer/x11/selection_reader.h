#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "viewer/x11/selection_atoms.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// Reads what is copied on the desktop. The session's thread.
class SelectionReader {
 public:
  /// Texts beyond `limit` bytes are left alone. `window` is ours and tells of its properties; all must outlive this.
  SelectionReader(const XConnection& connection, const SelectionAtoms& atoms, std::uint32_t window, std::size_t limit);

  void handle(const XEvent& event);
  /// UTF-8; each text once.
  [[nodiscard]] std::optional<std::string> takeText();
  /// A text was left alone. Once for each.
  [[nodiscard]] bool takeTooLong() { return std::exchange(tooLong_, false); }

 private:
  void ask(std::uint32_t target, std::uint32_t time);
  void answered(bool given, std::uint32_t target, std::uint32_t time);
  void readPiece();
  void finish(std::string text);

  const XConnection& connection_;
  const SelectionAtoms& atoms_;
  std::uint32_t window_;
  std::size_t limit_;
  int selectionEvent_ = 0;
  bool inPieces_ = false;
  std::string pieces_;
  bool tooLong_ = false;
  bool latin1_ = false;  // what was asked for
  std::optional<std::string> text_;
};

}  // namespace pixelflex::viewer
