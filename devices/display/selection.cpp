#include "devices/display/selection.h"

#include <xcb/xcb.h>
#include <xcb/xfixes.h>

#include <array>
#include <cstdlib>

#include "devices/display/display_error.h"

namespace pixelflex::devices {
namespace {

// Longer texts are handed over in parts, as X servers take requests of this size only.
constexpr std::size_t kPart = 200'000;

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};
template <class Reply>
std::unique_ptr<Reply, Free> owned(Reply* reply) {
  return std::unique_ptr<Reply, Free>(reply);
}

// Old programs leave the choice of the property to the owner.
xcb_atom_t propertyOf(const xcb_selection_request_event_t& request) {
  return request.property != XCB_NONE ? request.property : request.target;
}

}  // namespace

void SelectionDesk::Disconnect::operator()(xcb_connection_t* x) const {
  xcb_disconnect(x);
}

SelectionDesk::SelectionDesk(std::string_view name) : x_(xcb_connect(nullptr, nullptr)) {
  if (xcb_connection_has_error(x()) != 0) throw DisplayError("cannot reach the display's clipboard");
  selection = atom(name);
  utf8 = atom("UTF8_STRING");
  targets = atom("TARGETS");
  incremental = atom("INCR");
  property = atom("PIXELFLEX_CLIPBOARD");
  const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(x())).data->root;
  window = xcb_generate_id(x());
  const std::uint32_t events = XCB_EVENT_MASK_PROPERTY_CHANGE;
  xcb_create_window(x(), 0, window, root, 0, 0, 1, 1, 0, XCB_WINDOW_CLASS_INPUT_ONLY, XCB_COPY_FROM_PARENT,
                    XCB_CW_EVENT_MASK, &events);
  watchOwner(root);
}

std::uint32_t SelectionDesk::atom(std::string_view name) const {
  const auto reply = owned(xcb_intern_atom_reply(
      x(), xcb_intern_atom(x(), 0, static_cast<std::uint16_t>(name.size()), name.data()), nullptr));
  if (reply == nullptr) throw DisplayError("the X server is gone");
  return reply->atom;
}

void SelectionDesk::watchOwner(std::uint32_t root) {
  const auto* const fixes = xcb_get_extension_data(x(), &xcb_xfixes_id);
  if (fixes == nullptr || fixes->present == 0) throw DisplayError("the X server has no XFixes: no clipboard");
  std::free(xcb_xfixes_query_version_reply(x(), xcb_xfixes_query_version(x(), 5, 0), nullptr));
  ownerChanged = fixes->first_event + XCB_XFIXES_SELECTION_NOTIFY;
  xcb_xfixes_select_selection_input(x(), root, selection, XCB_XFIXES_SELECTION_EVENT_MASK_SET_SELECTION_OWNER);
}

void IncomingSelection::ask() {
  parts_.reset();
  tooLong_ = false;
  xcb_convert_selection(desk_.x(), desk_.window, desk_.selection, desk_.utf8, desk_.property, XCB_CURRENT_TIME);
}

std::optional<std::string> IncomingSelection::answered(std::uint32_t property) {
  if (property == XCB_NONE) return std::nullopt;
  auto [type, bytes] = take();
  refused_ = type == desk_.utf8 && !bytes;
  if (type == desk_.utf8) return bytes;
  if (type == desk_.incremental) parts_.emplace();
  return std::nullopt;
}

std::optional<std::string> IncomingSelection::continued() {
  if (!parts_) return std::nullopt;
  const auto [type, bytes] = take();
  if (type == XCB_NONE) return std::nullopt;  // the announcement's own
  tooLong_ = tooLong_ || !bytes || parts_->size() + bytes->size() > limit_;
  const bool last = bytes && bytes->empty();
  if (!last && !tooLong_) *parts_ += *bytes;
  if (!last) return std::nullopt;
  auto text = std::exchange(parts_, std::nullopt);
  refused_ = tooLong_;
  return tooLong_ ? std::nullopt : text;
}

/// The property's type and bytes (none beyond the limit); it is removed, which asks for the next part.
std::pair<std::uint32_t, std::optional<std::string>> IncomingSelection::take() {
  const auto words = static_cast<std::uint32_t>(limit_ / 4 + 1);
  const auto reply = owned(xcb_get_property_reply(
      desk_.x(), xcb_get_property(desk_.x(), 0, desk_.window, desk_.property, XCB_ATOM_ANY, 0, words), nullptr));
  if (reply == nullptr || reply->type == XCB_NONE) return {XCB_NONE, std::nullopt};
  xcb_delete_property(desk_.x(), desk_.window, desk_.property);
  const auto size = static_cast<std::size_t>(xcb_get_property_value_length(reply.get()));
  if (reply->bytes_after > 0 || size > limit_) return {reply->type, std::nullopt};
  return {reply->type, std::string(static_cast<const char*>(xcb_get_property_value(reply.get())), size)};
}

void OutgoingSelection::offer(std::string text) {
  text_ = std::move(text);
  xcb_set_selection_owner(desk_.x(), desk_.window, desk_.selection, XCB_CURRENT_TIME);
}

void OutgoingSelection::serve(const xcb_selection_request_event_t& request) {
  xcb_selection_notify_event_t answer{};
  answer.response_type = XCB_SELECTION_NOTIFY;
  answer.time = request.time;
  answer.requestor = request.requestor;
  answer.selection = request.selection;
  answer.target = request.target;
  answer.property = put(request) ? propertyOf(request) : static_cast<xcb_atom_t>(XCB_NONE);
  xcb_send_event(desk_.x(), 0, request.requestor, 0, reinterpret_cast<const char*>(&answer));
}

void OutgoingSelection::continueFor(std::uint32_t requestor, std::uint32_t property) {
  const auto found = transfers_.find({requestor, property});
  if (found == transfers_.end()) return;
  std::string& rest = found->second;
  write(requestor, property, std::string_view(rest).substr(0, kPart));
  if (rest.empty()) {
    transfers_.erase(found);
  } else {
    rest.erase(0, kPart);
  }
}

bool OutgoingSelection::put(const xcb_selection_request_event_t& request) {
  const xcb_atom_t property = propertyOf(request);
  if (request.target == desk_.targets) {
    const std::array<xcb_atom_t, 2> known{desk_.targets, desk_.utf8};
    xcb_change_property(desk_.x(), XCB_PROP_MODE_REPLACE, request.requestor, property, XCB_ATOM_ATOM, 32, 2,
                        known.data());
    return true;
  }
  if (request.target != desk_.utf8) return false;
  if (text_.size() > kPart) {
    begin(request.requestor, property);
  } else {
    write(request.requestor, property, text_);
  }
  return true;
}

void OutgoingSelection::begin(std::uint32_t requestor, std::uint32_t property) {
  const std::uint32_t events = XCB_EVENT_MASK_PROPERTY_CHANGE;
  xcb_change_window_attributes(desk_.x(), requestor, XCB_CW_EVENT_MASK, &events);
  const auto size = static_cast<std::uint32_t>(text_.size());
  xcb_change_property(desk_.x(), XCB_PROP_MODE_REPLACE, requestor, property, desk_.incremental, 32, 1, &size);
  transfers_[{requestor, property}] = text_;
}

void OutgoingSelection::write(std::uint32_t requestor, std::uint32_t property, std::string_view bytes) {
  xcb_change_property(desk_.x(), XCB_PROP_MODE_REPLACE, requestor, property, desk_.utf8, 8,
                      static_cast<std::uint32_t>(bytes.size()), bytes.data());
}

}  // namespace pixelflex::devices
