#include "viewer/vnc/tls_session.h"

#include <gnutls/gnutls.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

// TLS 1.3 knows no anonymous servers.
constexpr const char* kAnonymousPriority = "NORMAL:-VERS-ALL:+VERS-TLS1.2:-KX-ALL:+ANON-ECDH:+ANON-DH";
constexpr const char* kX509Priority = "NORMAL:-VERS-ALL:+VERS-TLS1.3:+VERS-TLS1.2";

void check(int result) {
  if (result < 0) throw std::runtime_error(::gnutls_strerror(result));
}

struct Transport {
  int socket = -1;
  int readFlags = MSG_DONTWAIT;
};

ssize_t pull(gnutls_transport_ptr_t pointer, void* bytes, std::size_t count) {
  const Transport& transport = *static_cast<Transport*>(pointer);
  return ::recv(transport.socket, bytes, count, transport.readFlags);
}

ssize_t push(gnutls_transport_ptr_t pointer, const void* bytes, std::size_t count) {
  const Transport& transport = *static_cast<Transport*>(pointer);
  return ::send(transport.socket, bytes, count, MSG_DONTWAIT | MSG_NOSIGNAL);
}

bool isAgain(ssize_t result) {
  return result == GNUTLS_E_AGAIN || result == GNUTLS_E_INTERRUPTED;
}

TlsSession::Transfer transferOf(ssize_t result) {
  if (isAgain(result)) return {0, true};
  check(static_cast<int>(result < 0 ? result : 0));
  return {static_cast<std::size_t>(result), false};
}

}  // namespace

struct TlsSession::State {
  explicit State(int socket) : transport{socket} { check(::gnutls_init(&session, GNUTLS_CLIENT | GNUTLS_NO_SIGNAL)); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    ::gnutls_deinit(session);
    if (anonymous != nullptr) ::gnutls_anon_free_client_credentials(anonymous);
    if (x509 != nullptr) ::gnutls_certificate_free_credentials(x509);
  }

  Transport transport;
  gnutls_session_t session = nullptr;
  gnutls_anon_client_credentials_t anonymous = nullptr;
  gnutls_certificate_credentials_t x509 = nullptr;
};

TlsSession::TlsSession(int socket, Kind kind, const std::string& hostName) : state_(std::make_unique<State>(socket)) {
  State& tls = *state_;
  ::gnutls_transport_set_ptr(tls.session, &tls.transport);
  ::gnutls_transport_set_pull_function(tls.session, pull);
  ::gnutls_transport_set_push_function(tls.session, push);
  if (kind == Kind::kAnonymous) {
    check(::gnutls_anon_allocate_client_credentials(&tls.anonymous));
    check(::gnutls_credentials_set(tls.session, GNUTLS_CRD_ANON, tls.anonymous));
    check(::gnutls_priority_set_direct(tls.session, kAnonymousPriority, nullptr));
    return;
  }
  check(::gnutls_certificate_allocate_credentials(&tls.x509));
  check(::gnutls_credentials_set(tls.session, GNUTLS_CRD_CERTIFICATE, tls.x509));
  check(::gnutls_priority_set_direct(tls.session, kX509Priority, nullptr));
  if (!hostName.empty()) {
    check(::gnutls_server_name_set(tls.session, GNUTLS_NAME_DNS, hostName.data(), hostName.size()));
  }
}

TlsSession::~TlsSession() = default;

bool TlsSession::handshake(Deadline deadline, const Signal& stop) {
  while (true) {
    const int result = ::gnutls_handshake(state_->session);
    if (result == GNUTLS_E_SUCCESS) return true;
    if (isAgain(result)) {
      const short event = ::gnutls_record_get_direction(state_->session) == 0 ? POLLIN : POLLOUT;
      if (!waitFor(state_->transport.socket, event, deadline, stop)) return false;
    } else if (::gnutls_error_is_fatal(result) != 0) {
      check(result);
    }
    // A server may send harmless warnings without end.
    if (std::chrono::steady_clock::now() >= deadline) return false;
  }
}

TlsSession::Transfer TlsSession::read(std::span<std::uint8_t> bytes) {
  return transferOf(::gnutls_record_recv(state_->session, bytes.data(), bytes.size()));
}

TlsSession::Transfer TlsSession::write(std::span<const std::uint8_t> bytes) {
  return transferOf(::gnutls_record_send(state_->session, bytes.data(), bytes.size()));
}

void TlsSession::letReadsBlock() {
  state_->transport.readFlags = 0;
}

bool TlsSession::hasPendingBytes() const {
  return ::gnutls_record_check_pending(state_->session) > 0;
}

std::vector<std::vector<std::uint8_t>> TlsSession::certificates() const {
  unsigned count = 0;
  const gnutls_datum_t* list = ::gnutls_certificate_get_peers(state_->session, &count);
  std::vector<std::vector<std::uint8_t>> chain;
  for (unsigned i = 0; list != nullptr && i < count; ++i) {
    chain.emplace_back(list[i].data, list[i].data + list[i].size);
  }
  return chain;
}

void* TlsSession::handle() const {
  return state_->session;
}

}  // namespace pixelflex::viewer
