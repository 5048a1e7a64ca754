#pragma once

#include <deque>
#include <memory>
#include <string>

#include "viewer/x11/selection_atoms.h"
#include "viewer/x11/x_connection.h"

namespace pixelflex::viewer {

/// Holds a text for whoever pastes on the desktop, until somebody copies something else there. The session's thread.
class SelectionOwner {
 public:
  /// `window` is ours; all must outlive this.
  SelectionOwner(const XConnection& connection, const SelectionAtoms& atoms, std::uint32_t window)
      : connection_(connection), atoms_(atoms), window_(window) {}

  /// UTF-8.
  void offer(std::string text);
  void handle(const XEvent& event);

 private:
  /// A long text on its way to a window: it takes a piece out of its property whenever it is ready for the next.
  struct Transfer {
    std::uint32_t requestor = 0;
    std::uint32_t property = 0;
    std::uint32_t target = 0;
    std::shared_ptr<const std::string> text;
    std::size_t sent = 0;
  };
  struct Request {
    std::uint32_t requestor = 0;
    std::uint32_t target = 0;
    std::uint32_t property = 0;
    std::uint32_t time = 0;
  };

  void answer(const Request& request);
  [[nodiscard]] bool give(const Request& request);
  void giveText(const Request& request, std::shared_ptr<const std::string> text);
  void giveNextPiece(std::uint32_t requestor, std::uint32_t property);

  const XConnection& connection_;
  const SelectionAtoms& atoms_;
  std::uint32_t window_;
  std::shared_ptr<const std::string> text_;
  std::deque<Transfer> transfers_;
};

}  // namespace pixelflex::viewer
