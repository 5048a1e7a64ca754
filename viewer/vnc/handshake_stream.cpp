#include "viewer/vnc/handshake_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

[[noreturn]] void lost(const std::string& where, const std::string& why = {}) {
  throw SessionError(CloseKind::kLost,
                     where + " closed the connection during the handshake" + (why.empty() ? "" : " (" + why + ")"));
}

TlsSession::Transfer transferOf(ssize_t result, const std::string& where) {
  if (result >= 0) return {static_cast<std::size_t>(result), false};
  if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return {0, true};
  lost(where, std::generic_category().message(errno));
}

}  // namespace

HandshakeStream::HandshakeStream(int socket, std::string where, Deadline deadline, const Signal& stop)
    : socket_(socket), where_(std::move(where)), deadline_(deadline), stop_(stop) {}

std::vector<std::uint8_t> HandshakeStream::read(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t got = 0; got < count;) got += readOnce(std::span(bytes).subspan(got));
  return bytes;
}

std::uint32_t HandshakeStream::readNumber(int bytes) {
  return bigEndian(read(static_cast<std::size_t>(bytes)));
}

std::string HandshakeStream::readText(std::size_t most) {
  const std::vector<std::uint8_t> bytes = read(std::min<std::size_t>(readNumber(4), most));
  return {bytes.begin(), bytes.end()};
}

std::string HandshakeStream::readSome(std::size_t count) {
  std::string text(count, '\0');
  text.resize(readOnce({reinterpret_cast<std::uint8_t*>(text.data()), text.size()}));
  return text;
}

void HandshakeStream::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) bytes = bytes.subspan(writeOnce(bytes));
}

void HandshakeStream::writeNumber(std::uint32_t value, int bytes) {
  std::vector<std::uint8_t> message;
  appendNumber(message, value, bytes);
  write(message);
}

void HandshakeStream::encrypt(TlsSession::Kind kind, const std::string& hostName) {
  try {
    auto tls = std::make_unique<TlsSession>(socket_, kind, hostName);
    if (!tls->handshake(deadline_, stop_)) {
      throw SessionError(CloseKind::kUnreachable, where_ + " stopped answering while encryption was set up");
    }
    tls_ = std::move(tls);
  } catch (const SessionError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw SessionError(CloseKind::kUntrusted, "no encrypted connection to " + where_ + " came about: " + error.what());
  }
}

std::size_t HandshakeStream::readOnce(std::span<std::uint8_t> bytes) {
  while (true) {
    TlsSession::Transfer done;
    try {
      done = tls_ ? tls_->read(bytes) : transferOf(::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT), where_);
    } catch (const SessionError&) {
      throw;
    } catch (const std::runtime_error& error) {
      lost(where_, error.what());
    }
    if (done.bytes > 0) return done.bytes;
    if (!done.again) lost(where_);
    wait(POLLIN);
  }
}

std::size_t HandshakeStream::writeOnce(std::span<const std::uint8_t> bytes) {
  while (true) {
    TlsSession::Transfer done;
    try {
      done = tls_ ? tls_->write(bytes)
                  : transferOf(::send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL), where_);
    } catch (const SessionError&) {
      throw;
    } catch (const std::runtime_error& error) {
      lost(where_, error.what());
    }
    if (done.bytes > 0) return done.bytes;
    wait(POLLOUT);
  }
}

void HandshakeStream::wait(short events) {
  if (waitFor(socket_, events, deadline_, stop_)) return;
  throw SessionError(CloseKind::kUnreachable, where_ + " accepted the connection but stopped answering");
}

}  // namespace pixelflex::viewer
