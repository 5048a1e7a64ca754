#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// The names under which X clients hand texts to each other (ICCCM, section 2).
struct SelectionAtoms {
  /// Of one selection, CLIPBOARD or PRIMARY.
  SelectionAtoms(const XConnection& connection, const std::string& name)
      : selection(connection.atom(name)),
        targets(connection.atom("TARGETS")),
        utf8(connection.atom("UTF8_STRING")),
        mimeUtf8(connection.atom("text/plain;charset=utf-8")),
        text(connection.atom("TEXT")),
        increments(connection.atom("INCR")),
        property(connection.atom("PIXELFLEX_" + name)) {}

  std::uint32_t selection;
  std::uint32_t targets;
  std::uint32_t utf8;
  std::uint32_t mimeUtf8;
  std::uint32_t text;
  std::uint32_t increments;
  std::uint32_t property;  // where our window takes texts
};

/// Longer texts go in pieces of this size.
inline constexpr std::size_t kSelectionPiece = std::size_t{1} << 18;

}  // namespace pixelflex::viewer
