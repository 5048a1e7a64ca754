#include "viewer/x11/x_display.h"

#include <X11/Xauth.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::string_view kCookieName = "MIT-MAGIC-COOKIE-1";
constexpr int kMaxDisplay = 65535;

// The first two numbers of the protocol, which has not changed since 1987.
constexpr std::uint16_t kProtocol = 11;
constexpr std::uint8_t kWelcome = 1;
constexpr std::size_t kAnswerHead = 8;

struct DisposeAuth {
  void operator()(Xauth* auth) const { XauDisposeAuth(auth); }
};

[[noreturn]] void refuseText(std::string_view text, const char* why) {
  throw std::invalid_argument("X display \"" + std::string(text) + "\": " + why + " (write x11::7 or x11::7.1)");
}

int parseNumber(std::string_view digits, std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool whole = !digits.empty() && error == std::errc() && end == digits.data() + digits.size();
  if (!whole || number < 0 || number > kMaxDisplay) refuseText(text, "an X server of this machine is a number");
  return number;
}

// 0, or why not (an errno).
int connectTo(int socket, const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, name.data(), name.size());
  const bool isAbstract = name.front() == '\0';
  const std::size_t length = offsetof(sockaddr_un, sun_path) + name.size() + (isAbstract ? 0 : 1);
  const bool connected =
      ::connect(socket, reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(length)) == 0;
  return connected ? 0 : errno;
}

void appendPadded(std::string& bytes, const std::string& text) {
  bytes += text;
  bytes.append((4 - text.size() % 4) % 4, '\0');
}

std::string greeting(const XCookie& cookie) {
  const std::array<std::uint16_t, 6> head{
      static_cast<std::uint16_t>(std::endian::native == std::endian::little ? 'l' : 'B'),
      kProtocol,
      0,
      static_cast<std::uint16_t>(cookie.name.size()),
      static_cast<std::uint16_t>(cookie.data.size()),
      0};
  std::string bytes(sizeof head, '\0');
  std::memcpy(bytes.data(), head.data(), sizeof head);
  appendPadded(bytes, cookie.name);
  appendPadded(bytes, cookie.data);
  return bytes;
}

// Up to `count` bytes; fewer when the server says no more in time.
std::string readBytes(int socket, std::size_t count, Deadline deadline, const Signal& stop) {
  std::string bytes(count, '\0');
  std::size_t have = 0;
  while (have < count && waitFor(socket, POLLIN, deadline, stop)) {
    const ssize_t got = ::recv(socket, bytes.data() + have, count - have, 0);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) break;
    have += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  bytes.resize(have);
  return bytes;
}

// Of a display of this machine, by its number.
bool isFor(const Xauth& entry, std::string_view host, std::string_view number) {
  const std::string_view address(entry.address, entry.address_length);
  const bool here = entry.family == FamilyWild || (entry.family == FamilyLocal && address == host);
  const std::string_view itsNumber(entry.number, entry.number_length);  // empty: any
  return here && (itsNumber.empty() || itsNumber == number) &&
         std::string_view(entry.name, entry.name_length) == kCookieName;
}

XCookie cookieIn(const std::string& path, std::string_view host, std::string_view number) {
  const std::unique_ptr<FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rbe"), &std::fclose);
  while (file != nullptr) {
    const std::unique_ptr<Xauth, DisposeAuth> entry(XauReadAuth(file.get()));
    if (entry == nullptr) break;
    if (isFor(*entry, host, number)) return {std::string(kCookieName), std::string(entry->data, entry->data_length)};
  }
  return {};
}

}  // namespace

std::string XDisplay::text() const {
  return ":" + std::to_string(number) + (screen == 0 ? "" : "." + std::to_string(screen));
}

XDisplay parseXDisplay(std::string_view text) {
  const std::string_view digits = text.starts_with(':') ? text.substr(1) : text;
  const std::size_t dot = digits.find('.');
  if (dot == std::string_view::npos) return {parseNumber(digits, text), 0};
  return {parseNumber(digits.substr(0, dot), text), parseNumber(digits.substr(dot + 1), text)};
}

XCookie cookieFor(const XDisplay& display) {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return {};
  const std::string number = std::to_string(display.number);
  if (const char* file = std::getenv("PIXELFLEX_XAUTHORITY")) {
    const XCookie cookie = cookieIn(file, host.data(), number);
    if (!cookie.data.empty()) return cookie;
  }
  const auto length = [](std::string_view text) { return static_cast<unsigned short>(text.size()); };
  const std::unique_ptr<Xauth, DisposeAuth> found(XauGetAuthByAddr(FamilyLocal, length(host.data()), host.data(),
                                                                   length(number), number.c_str(), length(kCookieName),
                                                                   kCookieName.data()));
  if (found == nullptr) return {};
  return {std::string(kCookieName), std::string(found->data, found->data_length)};
}

FileDescriptor connectToDisplay(const XDisplay& display) {
  const std::string path = "/tmp/.X11-unix/X" + std::to_string(display.number);
  int error = 0;
  // Most servers listen both in the abstract name space and in the file system; some only in one.
  for (const std::string& name : {std::string(1, '\0') + path, path}) {
    FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (socket.get() < 0) throw std::system_error(errno, std::generic_category(), "socket");
    error = connectTo(socket.get(), name);
    if (error == 0) return socket;
  }
  const std::string why = error == ENOENT || error == ECONNREFUSED ? "is it running on this machine?"
                                                                   : std::generic_category().message(error);
  throw SessionError(CloseKind::kUnreachable, "no X server answers at display " + display.text() + ": " + why);
}

void requireWelcome(const XDisplay& display, int socket, const XCookie& cookie, Deadline deadline, const Signal& stop) {
  const std::string bytes = greeting(cookie);
  const bool sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  const std::string head = sent ? readBytes(socket, kAnswerHead, deadline, stop) : std::string();
  const std::string server = "the X server " + display.text();
  if (head.size() < kAnswerHead) throw SessionError(CloseKind::kLost, server + " does not answer");
  if (head[0] == kWelcome) return;
  std::string reason = readBytes(socket, static_cast<std::uint8_t>(head[1]), deadline, stop);
  while (reason.ends_with('\n')) reason.pop_back();
  throw SessionError(CloseKind::kAuthentication,
                     server + " does not let us in: \"" + reason +
                         "\" (its user can allow it with xhost +si:localuser:NAME, or set XAUTHORITY to its file)");
}

}  // namespace pixelflex::viewer
