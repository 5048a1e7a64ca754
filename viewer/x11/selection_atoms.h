#pragma once

#include <cstddef>
#include <cstdint>

#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// The names under which X clients hand texts to each other (ICCCM, section 2).
struct SelectionAtoms {
  explicit SelectionAtoms(const XConnection& connection)
      : clipboard(connection.atom("CLIPBOARD")),
        targets(connection.atom("TARGETS")),
        utf8(connection.atom("UTF8_STRING")),
        mimeUtf8(connection.atom("text/plain;charset=utf-8")),
        text(connection.atom("TEXT")),
        increments(connection.atom("INCR")),
        property(connection.atom("PIXELFLEX_CLIPBOARD")) {}

  std::uint32_t clipboard;
  std::uint32_t targets;
  std::uint32_t utf8;
  std::uint32_t mimeUtf8;
  std::uint32_t text;
  std::uint32_t increments;
  std::uint32_t property;  // where our window takes texts
};

/// Longer texts go in pieces of this size.
inline constexpr std::size_t kSelectionPiece = std::size_t{1} << 18;
/// Longer texts are left alone, either way.
inline constexpr std::size_t kMaxSelection = std::size_t{16} << 20;

}  // namespace pixelflex::viewer
