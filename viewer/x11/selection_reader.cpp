#include "viewer/x11/selection_reader.h"

#include <xcb/xcb.h>
#include <xcb/xfixes.h>

#include <utility>

#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {

SelectionReader::SelectionReader(const XConnection& connection, const SelectionAtoms& atoms, std::uint32_t window,
                                 std::size_t limit)
    : connection_(connection),
      atoms_(atoms),
      window_(window),
      limit_(limit),
      selectionEvent_(connection.requireExtension("XFIXES").firstEvent + XCB_XFIXES_SELECTION_NOTIFY) {
  xcb_xfixes_select_selection_input(connection.get(), window, atoms.selection,
                                    XCB_XFIXES_SELECTION_EVENT_MASK_SET_SELECTION_OWNER);
}

void SelectionReader::handle(const XEvent& event) {
  if (event.type() == selectionEvent_) {
    const auto& changed = event.as<xcb_xfixes_selection_notify_event_t>();
    if (changed.selection == atoms_.selection && changed.owner != window_ && changed.owner != XCB_NONE)
      ask(atoms_.utf8, changed.timestamp);
  } else if (event.type() == XCB_SELECTION_NOTIFY) {
    const auto& answer = event.as<xcb_selection_notify_event_t>();
    if (answer.requestor == window_) answered(answer.property != XCB_NONE, answer.target, answer.time);
  } else if (event.type() == XCB_PROPERTY_NOTIFY && inPieces_) {
    const auto& changed = event.as<xcb_property_notify_event_t>();
    const bool ours = changed.window == window_ && changed.atom == atoms_.property;
    if (ours && changed.state == XCB_PROPERTY_NEW_VALUE) readPiece();
  }
}

std::optional<std::string> SelectionReader::takeText() {
  return std::exchange(text_, std::nullopt);
}

void SelectionReader::ask(std::uint32_t target, std::uint32_t time) {
  inPieces_ = false;
  pieces_.clear();
  latin1_ = target == XCB_ATOM_STRING;
  xcb_delete_property(connection_.get(), window_, atoms_.property);
  xcb_convert_selection(connection_.get(), window_, atoms_.selection, target, atoms_.property, time);
}

void SelectionReader::answered(bool given, std::uint32_t target, std::uint32_t time) {
  if (given) return readPiece();
  // Old programs know Latin-1 only.
  if (target == atoms_.utf8) ask(XCB_ATOM_STRING, time);
}

void SelectionReader::readPiece() {
  const auto property = connection_.reply<xcb_get_property_reply_t>(
      xcb_get_property(connection_.get(), 1, window_, atoms_.property, XCB_GET_PROPERTY_TYPE_ANY, 0,
                       static_cast<std::uint32_t>(limit_ / 4 + 1)));
  if (property == nullptr) return;
  if (property->type == atoms_.increments) {
    inPieces_ = true;
    return;
  }
  const auto length = static_cast<std::size_t>(xcb_get_property_value_length(property.get()));
  const bool tooLong = property->bytes_after > 0 || pieces_.size() + length > limit_;
  if (property->format != 8 || tooLong) {
    // What is too long is left unread, which its owner gets over.
    inPieces_ = false;
    pieces_.clear();
    tooLong_ = tooLong;
    return;
  }
  pieces_.append(static_cast<const char*>(xcb_get_property_value(property.get())), length);
  if (!inPieces_ || length == 0) finish(std::exchange(pieces_, {}));
}

void SelectionReader::finish(std::string text) {
  inPieces_ = false;
  text_ = latin1_ ? utf8FromLatin1(text) : utf8FromEither(text);
}

}  // namespace pixelflex::viewer
