#include "viewer/x11/x_connection.h"

#include <fcntl.h>
#include <poll.h>
#include <xcb/xcb.h>
#include <xcb/xcbext.h>

#include <cerrno>
#include <system_error>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSettle{300};

}  // namespace

void XConnection::Disconnect::operator()(xcb_connection_t* connection) const {
  xcb_disconnect(connection);
}

XConnection::XConnection(const XDisplay& display, const Signal& stop, std::chrono::milliseconds patience)
    : display_(display), stop_(stop), patience_(patience) {
  const XCookie cookie = cookieFor(display);
  const Deadline deadline = Clock::now() + patience;
  // Stays until the real connection is there: a server may start anew when its last client leaves.
  const FileDescriptor welcome = connectToDisplay(display);
  requireWelcome(display, welcome.get(), cookie, deadline, stop_);
  open(cookie);
  findScreen();
}

void XConnection::open(const XCookie& cookie) {
  const FileDescriptor socket = connectToDisplay(display_);
  // libxcb closes its own.
  const int own = ::fcntl(socket.get(), F_DUPFD_CLOEXEC, 0);
  if (own < 0) throw std::system_error(errno, std::generic_category(), "dup");
  XCookie sent = cookie;
  xcb_auth_info_t auth{static_cast<int>(sent.name.size()), sent.name.data(), static_cast<int>(sent.data.size()),
                       sent.data.data()};
  connection_.reset(xcb_connect_to_fd(own, sent.name.empty() ? nullptr : &auth));
  requireConnection();
}

void XConnection::findScreen() {
  auto screens = xcb_setup_roots_iterator(xcb_get_setup(get()));
  if (display_.screen >= screens.rem) refuse("has no screen " + std::to_string(display_.screen));
  for (int i = 0; i < display_.screen; ++i) xcb_screen_next(&screens);
  root_ = screens.data->root;
}

int XConnection::fd() const {
  return xcb_get_file_descriptor(get());
}

std::uint32_t XConnection::newId() const {
  return xcb_generate_id(get());
}

void* XConnection::waitForReply(unsigned sequence) const {
  flush();
  const Deadline deadline = Clock::now() + patience_;
  void* reply = nullptr;
  xcb_generic_error_t* error = nullptr;
  while (xcb_poll_for_reply(get(), sequence, &reply, &error) == 0) {
    if (!waitFor(fd(), POLLIN, deadline, stop_)) {
      throw SessionError(CloseKind::kLost, "the X server " + display_.text() + " does not answer any more");
    }
  }
  const Owned<xcb_generic_error_t> freed(error);
  requireConnection();
  return reply;
}

std::optional<XEvent> XConnection::nextEvent() const {
  void* event = xcb_poll_for_event(get());
  requireConnection();
  if (event == nullptr) return std::nullopt;
  return XEvent(event);
}

void XConnection::flush() const {
  xcb_flush(get());
  requireConnection();
}

void XConnection::settle() const noexcept {
  const Deadline deadline = Clock::now() + kSettle;
  const unsigned sequence = xcb_get_input_focus(get()).sequence;
  xcb_flush(get());
  void* reply = nullptr;
  xcb_generic_error_t* error = nullptr;
  while (xcb_poll_for_reply(get(), sequence, &reply, &error) == 0 && Clock::now() < deadline) {
    pollfd watched{fd(), POLLIN, 0};
    ::poll(&watched, 1, millisecondsUntil(deadline));
  }
  std::free(reply);
  std::free(error);
}

void XConnection::requireConnection() const {
  if (xcb_connection_has_error(get()) == 0) return;
  throw SessionError(CloseKind::kLost, "the X server " + display_.text() + " is gone");
}

std::uint32_t XConnection::atom(const std::string& name) const {
  const auto found =
      reply<xcb_intern_atom_reply_t>(xcb_intern_atom(get(), 0, static_cast<std::uint16_t>(name.size()), name.c_str()));
  return found == nullptr ? 0 : found->atom;
}

std::optional<XExtension> XConnection::findExtension(const std::string& name) const {
  const auto found = reply<xcb_query_extension_reply_t>(
      xcb_query_extension(get(), static_cast<std::uint16_t>(name.size()), name.c_str()));
  if (found == nullptr || found->present == 0) return std::nullopt;
  return XExtension{found->first_event, found->major_opcode};
}

XExtension XConnection::requireExtension(const std::string& name) const {
  const auto found = findExtension(name);
  if (!found) refuse("does not have the extension " + name);
  return *found;
}

void XConnection::refuse(const std::string& why) const {
  throw SessionError(CloseKind::kUnsupported, "the X server " + display_.text() + " " + why);
}

}  // namespace pixelflex::viewer
