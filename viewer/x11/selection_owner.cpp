#include "viewer/x11/selection_owner.h"

#include <xcb/xcb.h>

#include <algorithm>
#include <array>
#include <utility>

#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {
namespace {

// Windows that never take their pieces must not hold texts for ever.
constexpr std::size_t kMaxTransfers = 16;

void setProperty(xcb_connection_t* x, std::uint32_t window, std::uint32_t property, std::uint32_t type,
                 std::string_view bytes) {
  xcb_change_property(x, XCB_PROP_MODE_REPLACE, window, property, type, 8, static_cast<std::uint32_t>(bytes.size()),
                      bytes.data());
}

}  // namespace

void SelectionOwner::offer(std::string text) {
  text_ = std::make_shared<const std::string>(std::move(text));
  xcb_set_selection_owner(connection_.get(), window_, atoms_.selection, XCB_CURRENT_TIME);
}

void SelectionOwner::handle(const XEvent& event) {
  if (event.type() == XCB_SELECTION_REQUEST) {
    const auto& asked = event.as<xcb_selection_request_event_t>();
    // Programs of before 1989 leave the choice of the property to us.
    const std::uint32_t property = asked.property == XCB_NONE ? asked.target : asked.property;
    if (asked.owner == window_) answer({asked.requestor, asked.target, property, asked.time});
  } else if (event.type() == XCB_SELECTION_CLEAR) {
    if (event.as<xcb_selection_clear_event_t>().owner == window_) text_.reset();
  } else if (event.type() == XCB_PROPERTY_NOTIFY) {
    const auto& changed = event.as<xcb_property_notify_event_t>();
    if (changed.state == XCB_PROPERTY_DELETE) giveNextPiece(changed.window, changed.atom);
  }
}

void SelectionOwner::answer(const Request& request) {
  xcb_selection_notify_event_t told{};
  told.response_type = XCB_SELECTION_NOTIFY;
  told.time = request.time;
  told.requestor = request.requestor;
  told.selection = atoms_.selection;
  told.target = request.target;
  told.property = give(request) ? request.property : XCB_NONE;
  xcb_send_event(connection_.get(), 0, request.requestor, 0, reinterpret_cast<const char*>(&told));
}

bool SelectionOwner::give(const Request& request) {
  if (text_ == nullptr) return false;
  if (request.target == atoms_.targets) {
    const std::array<std::uint32_t, 5> targets{atoms_.targets, atoms_.utf8, atoms_.mimeUtf8, atoms_.text,
                                               XCB_ATOM_STRING};
    xcb_change_property(connection_.get(), XCB_PROP_MODE_REPLACE, request.requestor, request.property, XCB_ATOM_ATOM,
                        32, static_cast<std::uint32_t>(targets.size()), targets.data());
    return true;
  }
  if (request.target == XCB_ATOM_STRING) {
    giveText(request, std::make_shared<const std::string>(latin1FromUtf8(*text_)));
    return true;
  }
  if (request.target != atoms_.utf8 && request.target != atoms_.mimeUtf8 && request.target != atoms_.text) return false;
  Request typed = request;
  if (typed.target == atoms_.text) typed.target = atoms_.utf8;
  giveText(typed, text_);
  return true;
}

void SelectionOwner::giveText(const Request& request, std::shared_ptr<const std::string> text) {
  xcb_connection_t* x = connection_.get();
  if (text->size() <= kSelectionPiece)
    return setProperty(x, request.requestor, request.property, request.target, *text);
  const std::uint32_t mask = XCB_EVENT_MASK_PROPERTY_CHANGE;
  xcb_change_window_attributes(x, request.requestor, XCB_CW_EVENT_MASK, &mask);
  const auto atLeast = static_cast<std::uint32_t>(text->size());
  xcb_change_property(x, XCB_PROP_MODE_REPLACE, request.requestor, request.property, atoms_.increments, 32, 1,
                      &atLeast);
  if (transfers_.size() >= kMaxTransfers) transfers_.pop_front();
  transfers_.push_back({request.requestor, request.property, request.target, std::move(text)});
}

void SelectionOwner::giveNextPiece(std::uint32_t requestor, std::uint32_t property) {
  const auto transfer = std::ranges::find_if(transfers_, [&](const Transfer& candidate) {
    return candidate.requestor == requestor && candidate.property == property;
  });
  if (transfer == transfers_.end()) return;
  const std::string_view piece = std::string_view(*transfer->text).substr(transfer->sent, kSelectionPiece);
  setProperty(connection_.get(), requestor, property, transfer->target, piece);
  transfer->sent += piece.size();
  // An empty piece is the end.
  if (piece.empty()) transfers_.erase(transfer);
}

}  // namespace pixelflex::viewer
